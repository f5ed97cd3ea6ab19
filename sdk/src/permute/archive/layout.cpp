#include <algorithm>
#include <cstring>
#include <memory>
#include <numeric>
#include <set>

#include "permute/archive/contents.hpp"
#include "permute/archive/output_order.hpp"

namespace relievo::archive {

namespace {

constexpr std::size_t kMostRecords = 0xffffffff;

/// Gives each number a new one when it first comes.
class Renumbering {
 public:
  explicit Renumbering(std::size_t count) : numbers_(count, kNone) {}

  std::uint32_t operator()(std::uint32_t old) {
    if (numbers_[old] == kNone) {
      numbers_[old] = static_cast<std::uint32_t>(order_.size());
      order_.push_back(old);
    }
    return numbers_[old];
  }
  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  std::vector<std::uint32_t> numbers_, order_;
};

struct Tables {
  std::string text;
  std::vector<StringRecord> strings;
  std::vector<AxisRecord> axes;
  std::vector<TargetRecord> targets;
  std::vector<std::uint16_t> values;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> slots;
  std::vector<EntryRecord> entries;
  std::vector<ProgramRecord> programs;
  std::vector<OutputRecord> outputs;
  std::vector<AbsenceRecord> absences;
  std::vector<AbsentTargetRecord> absent_targets;
  std::vector<BlobRecord> blobs;

  std::uint32_t add_string(std::string_view string) {
    strings.push_back({static_cast<std::uint32_t>(text.size()), static_cast<std::uint32_t>(string.size())});
    text += string;
    return static_cast<std::uint32_t>(strings.size() - 1);
  }
};

using TargetNumbers = std::map<std::tuple<int, int>, std::uint16_t>;

void add_axes(const Contents& contents, Tables& tables) {
  for (const ArchiveAxis& axis : contents.axes) {
    const std::uint32_t name = tables.add_string(axis.name);
    for (const std::string& value : axis.values) tables.add_string(value);
    tables.axes.push_back({name, name + 1, static_cast<std::uint32_t>(axis.values.size()), axis.default_value});
  }
}

/// Permutations by their values, with programs and absences by first use.
void add_entries(const Contents& contents, Tables& tables, Renumbering& programs, Renumbering& absences) {
  std::vector<std::uint32_t> order(contents.permutations.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&contents](std::uint32_t a, std::uint32_t b) {
    return std::ranges::lexicographical_compare(contents.values_of(a), contents.values_of(b));
  });
  for (const std::uint32_t old : order) {
    const CollectedPermutation& permutation = contents.permutations[old];
    const std::uint32_t absence = permutation.absence == kNone ? kNone : absences(permutation.absence);
    tables.entries.push_back({programs(permutation.program), absence});
    tables.keys.push_back(permutation.key);
    const auto values = contents.values_of(old);
    tables.values.insert(tables.values.end(), values.begin(), values.end());
  }
}

void add_slots(Tables& tables) {
  tables.slots.assign(slot_count(tables.keys.size()), kNone);
  const std::uint64_t mask = tables.slots.size() - 1;
  for (std::uint32_t entry = 0; entry < tables.keys.size(); ++entry) {
    std::uint64_t slot = tables.keys[entry] & mask;
    while (tables.slots[slot] != kNone) slot = (slot + 1) & mask;
    tables.slots[slot] = entry;
  }
}

/// The targets of the programs and absences that are used.
TargetNumbers add_targets(const Contents& contents, Tables& tables, const Renumbering& programs,
                          const Renumbering& absences) {
  std::set<std::tuple<int, int>> targets;
  for (const std::uint32_t program : programs.order()) {
    for (const ProgramOutputBlob& output : contents.programs[program].outputs) targets.insert(order_of(output.target));
  }
  for (const std::uint32_t absence : absences.order()) {
    for (const auto& [language, version, reason] : *contents.absences[absence]) targets.insert({language, version});
  }
  TargetNumbers numbers;
  for (const auto& [language, version] : targets) {
    numbers.emplace(std::make_tuple(language, version), static_cast<std::uint16_t>(tables.targets.size()));
    tables.targets.push_back({static_cast<std::uint32_t>(language), static_cast<std::uint32_t>(version)});
  }
  return numbers;
}

void add_programs(const Contents& contents, Tables& tables, const Renumbering& programs, const TargetNumbers& targets,
                  Renumbering& blobs) {
  for (const std::uint32_t old : programs.order()) {
    const CollectedProgram& program = contents.programs[old];
    const auto first = static_cast<std::uint32_t>(tables.outputs.size());
    for (const ProgramOutputBlob& output : program.outputs) {
      tables.outputs.push_back(
          {static_cast<std::uint16_t>(output.stage), targets.at(order_of(output.target)), blobs(output.blob)});
    }
    const std::uint32_t reflection = blobs(program.reflection);
    tables.programs.push_back(
        {first, static_cast<std::uint32_t>(program.outputs.size()), reflection, blobs(program.cost)});
  }
}

void add_absences(const Contents& contents, Tables& tables, const Renumbering& absences, const TargetNumbers& targets) {
  std::map<std::string_view, std::uint32_t> reasons;
  for (const std::uint32_t old : absences.order()) {
    const Absence& absence = *contents.absences[old];
    tables.absences.push_back(
        {static_cast<std::uint32_t>(tables.absent_targets.size()), static_cast<std::uint32_t>(absence.size())});
    for (const auto& [language, version, reason] : absence) {
      const auto [known, is_new] = reasons.try_emplace(reason, 0);
      if (is_new) known->second = tables.add_string(reason);
      tables.absent_targets.push_back({targets.at({language, version}), known->second});
    }
  }
}

/// Returns where the last one ends.
std::uint64_t add_blobs(std::span<const SpooledBlob> spooled, std::span<const std::uint32_t> order, Tables& tables) {
  std::uint64_t offset = sizeof(Header);
  for (const std::uint32_t number : order) {
    const SpooledBlob& blob = spooled[number];
    tables.blobs.push_back({offset, blob.size, blob.hash});
    offset = aligned(offset + blob.size);
  }
  return offset;
}

/// The spool lays blobs out as an archive does, so all of them in order are in place.
bool is_in_place(std::span<const SpooledBlob> spooled, std::span<const std::uint32_t> order) {
  if (spooled.size() != order.size()) return false;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (order[i] != i) return false;
  }
  return true;
}

/// Calls `each` with the section's records, in the order of the file.
template <class Each>
void for_each_section(const Tables& t, const Each& each) {
  each(std::span<const char>(t.text));
  each(std::span(t.strings));
  each(std::span(t.axes));
  each(std::span(t.targets));
  each(std::span(t.values));
  each(std::span(t.keys));
  each(std::span(t.slots));
  each(std::span(t.entries));
  each(std::span(t.programs));
  each(std::span(t.outputs));
  each(std::span(t.absences));
  each(std::span(t.absent_targets));
  each(std::span(t.blobs));
}

Header make_header(const Tables& tables, std::uint64_t index_offset) {
  Header header{};
  std::ranges::copy(kMagic, header.magic.begin());
  header.version = kVersion;
  header.endian_mark = kEndianMark;
  header.section_count = kSectionCount;
  header.index_offset = index_offset;
  std::uint64_t offset = index_offset;
  std::size_t section = 0;
  for_each_section(tables, [&](auto records) {
    header.sections[section++] = {offset, records.size_bytes()};
    offset = aligned(offset + records.size_bytes());
  });
  header.file_size = offset;
  return header;
}

std::string index_bytes(const Header& header, const Tables& tables) {
  std::string bytes(static_cast<std::size_t>(header.file_size - header.index_offset), '\0');
  std::size_t section = 0;
  for_each_section(tables, [&](auto records) {
    const std::uint64_t offset = header.sections[section++].offset - header.index_offset;
    if (!records.empty()) std::memcpy(bytes.data() + offset, records.data(), records.size_bytes());
  });
  return bytes;
}

std::string header_bytes(Header header, std::string_view index) {
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  header.index_hash = hash64(std::string_view(bytes).substr(kHashedFrom), index);
  std::memcpy(bytes.data() + offsetof(Header, index_hash), &header.index_hash, sizeof header.index_hash);
  return bytes;
}

}  // namespace

Result<Layout> lay_out(const Contents& contents, std::span<const SpooledBlob> spooled) {
  Tables tables;
  Renumbering programs(contents.programs.size()), absences(contents.absences.size()), blobs(spooled.size());
  add_axes(contents, tables);
  add_entries(contents, tables, programs, absences);
  add_slots(tables);
  const TargetNumbers targets = add_targets(contents, tables, programs, absences);
  add_programs(contents, tables, programs, targets, blobs);
  add_absences(contents, tables, absences, targets);
  if (std::max({tables.text.size(), tables.entries.size(), tables.outputs.size(), tables.absent_targets.size()}) >=
          kMostRecords ||
      targets.size() > 0xffff) {
    return fail(ErrorCode::io, "archive.write", "the archive has more than 4294967294 records of a kind");
  }
  const std::uint64_t index_offset = add_blobs(spooled, blobs.order(), tables);
  const Header header = make_header(tables, index_offset);
  Layout layout;
  layout.index = index_bytes(header, tables);
  layout.header = header_bytes(header, layout.index);
  layout.index_offset = index_offset;
  layout.blobs = blobs.order();
  layout.is_spool = is_in_place(spooled, blobs.order());
  return layout;
}

std::uint64_t hash64(std::string_view first, std::string_view second) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
  XXH3_64bits_reset(state.get());
  XXH3_64bits_update(state.get(), first.data(), first.size());
  XXH3_64bits_update(state.get(), second.data(), second.size());
  return XXH3_64bits_digest(state.get());
}

}  // namespace relievo::archive
