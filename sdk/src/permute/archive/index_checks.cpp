/// What an index must keep so that no look-up leaves it. The order is the writer's, so an archive has one form only.
#include <algorithm>
#include <limits>

#include "permute/archive/index.hpp"
#include "permute/archive/naming.hpp"
#include "permute/archive/output_order.hpp"

namespace relievo::archive {

namespace {

/// The strings fill the text, one after the other.
bool strings_fit(const Index& index) {
  std::uint64_t expected = 0;
  for (const StringRecord& string : index.strings) {
    if (string.offset != expected || string.size > index.text.size() - expected) return false;
    expected += string.size;
  }
  return expected == index.text.size();
}

/// Numbers by first use: each is at most one beyond those seen.
class FirstUses {
 public:
  bool add(std::uint32_t number) {
    if (number > count_) return false;
    count_ += number == count_;
    return true;
  }
  std::uint64_t count() const { return count_; }

 private:
  std::uint64_t count_ = 0;
};

bool ascends(const OutputRecord& a, const OutputRecord& b) {
  return a.stage != b.stage ? a.stage < b.stage : a.target < b.target;
}

/// Every target is that of an output, or absent somewhere.
bool targets_are_used(const Index& index) {
  std::vector<bool> used(index.targets.size());
  for (const OutputRecord& output : index.outputs) used[output.target] = true;
  for (const AbsentTargetRecord& absent : index.absent_targets) used[absent.target] = true;
  return std::ranges::find(used, false) == used.end();
}

/// A slot for every entry, where probing for its key finds it.
bool slots_find_all(const Index& index) {
  const std::uint64_t mask = index.slots.size() - 1;
  for (std::uint32_t entry = 0; entry < index.keys.size(); ++entry) {
    std::uint64_t slot = index.keys[entry] & mask;
    for (; index.slots[slot] != entry; slot = (slot + 1) & mask) {
      if (index.slots[slot] == kNone || index.keys[index.slots[slot]] == index.keys[entry]) return false;
    }
  }
  return true;
}

}  // namespace

std::string fault_of_axes(Index& index) {
  if (!strings_fit(index)) return "its strings do not fit";
  std::uint64_t next = 0;
  for (const AxisRecord& record : index.axis_records) {
    const std::uint64_t values_end = next + 1 + record.value_count;
    const bool fits = record.name == next && record.first_value == next + 1 && values_end <= index.strings.size();
    if (!fits || record.default_value > kNoValue) return "an axis does not fit";
    ArchiveAxis& axis = index.axes.emplace_back();
    axis.name = index.string(record.name);
    for (std::uint32_t i = 0; i < record.value_count; ++i)
      axis.values.emplace_back(index.string(record.first_value + i));
    axis.default_value = static_cast<std::uint16_t>(record.default_value);
    next = values_end;
  }
  return fault_of(std::span<const ArchiveAxis>(index.axes));
}

std::string fault_of_targets(Index& index) {
  if (index.target_records.size() > std::numeric_limits<std::uint16_t>::max()) return "it has too many targets";
  for (const TargetRecord& record : index.target_records) {
    if (!is_language(record.language) || record.version > std::uint32_t{std::numeric_limits<int>::max()})
      return "a target is none";
    const Target target{static_cast<Language>(record.language), static_cast<int>(record.version)};
    if (!index.targets.empty() && order_of(index.targets.back()) >= order_of(target))
      return "its targets are not in order";
    index.targets.push_back(target);
  }
  return {};
}

std::string fault_of_entries(const Index& index) {
  const std::size_t count = index.entries.size();
  if (count >= kNone || index.keys.size() != count || index.values.size() != count * index.axes.size() ||
      index.slots.size() != slot_count(count))
    return "its tables of permutations differ in size";
  FirstUses programs, absences;
  for (std::uint32_t entry = 0; entry < count; ++entry) {
    const auto values = index.values_of(entry);
    if (!in_range(index.axes, values)) return "a permutation has a value that its axis lacks";
    if (entry > 0 && !std::ranges::lexicographical_compare(index.values_of(entry - 1), values))
      return "its permutations are not in order";
    const EntryRecord& record = index.entries[entry];
    if (!programs.add(record.program)) return "a permutation has a program that is not there";
    if (record.absence != kNone && !absences.add(record.absence)) return "a permutation's absent targets are not there";
  }
  if (programs.count() != index.programs.size() || absences.count() != index.absences.size())
    return "it has programs or absences that no permutation uses";
  return {};
}

std::string fault_of_keys(const Index& index) {
  const ValueKeys keys(index.axes);
  for (std::uint32_t entry = 0; entry < index.keys.size(); ++entry) {
    if (keys.key(index.values_of(entry)) != index.keys[entry]) return "a key is not that of its permutation";
  }
  std::size_t used = 0;
  for (const std::uint32_t slot : index.slots) {
    if (slot == kNone) continue;
    if (slot >= index.keys.size()) return "its key table points outside";
    ++used;
  }
  return used == index.keys.size() && slots_find_all(index) ? std::string() : "its key table does not find every key";
}

std::string fault_of_programs(const Index& index) {
  std::uint64_t next = 0;
  FirstUses blobs;
  for (const ProgramRecord& program : index.programs) {
    if (program.first_output != next || program.output_count > index.outputs.size() - next)
      return "the outputs of a program do not fit";
    const auto outputs = index.outputs_of(program);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      if (!is_stage(outputs[i].stage) || outputs[i].target >= index.targets.size() || !blobs.add(outputs[i].blob))
        return "an output of a program is none";
      if (i > 0 && !ascends(outputs[i - 1], outputs[i])) return "the outputs of a program are not in order";
    }
    if (!blobs.add(program.reflection) || !blobs.add(program.cost)) return "a program has a blob that is not there";
    next += outputs.size();
  }
  if (next != index.outputs.size() || blobs.count() != index.blobs.size())
    return "it has outputs or blobs that no program uses";
  return {};
}

std::string fault_of_absences(const Index& index) {
  std::uint64_t next = 0, next_string = 0;
  for (const AxisRecord& axis : index.axis_records) next_string += 1 + std::uint64_t{axis.value_count};
  const std::uint64_t first_reason = next_string;
  for (const AbsenceRecord& absence : index.absences) {
    if (absence.first != next || absence.count == 0 || absence.count > index.absent_targets.size() - next)
      return "a list of absent targets does not fit";
    next += absence.count;
    for (std::uint64_t i = absence.first; i < next; ++i) {
      const AbsentTargetRecord& record = index.absent_targets[i];
      if (record.target >= index.targets.size() || record.reason < first_reason || record.reason > next_string)
        return "an absent target is none";
      if (i > absence.first && index.absent_targets[i - 1].target >= record.target)
        return "a list of absent targets is not in order";
      next_string += record.reason == next_string;
    }
  }
  if (next != index.absent_targets.size() || next_string != index.strings.size())
    return "it has absent targets or strings that nothing uses";
  return targets_are_used(index) ? std::string() : "it has targets that nothing uses";
}

std::string fault_of_blobs(const Index& index) {
  std::uint64_t expected = sizeof(Header);
  for (const BlobRecord& blob : index.blobs) {
    if (blob.offset != expected || blob.size > index.blobs_end - expected) return "a blob does not fit";
    expected = aligned(expected + blob.size);
    if (expected > index.blobs_end) return "a blob does not fit";
  }
  return expected == index.blobs_end ? std::string() : "bytes follow its last blob";
}

}  // namespace relievo::archive
