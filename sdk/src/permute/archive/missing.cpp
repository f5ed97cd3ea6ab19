#include "permute/archive/missing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "permute/archive/naming.hpp"

namespace relievo::archive {

namespace {

using Assignment = std::span<const std::pair<std::string_view, std::string_view>>;

constexpr std::size_t kMostNearest = 3;
constexpr std::size_t kMostListed = 12;                ///< of an axis's values or a program's outputs, in a message
constexpr std::uint16_t kUnknownValue = kNoValue - 1;  ///< beyond every axis

/// What is asked of each axis, and what no axis can answer.
struct Wanted {
  std::vector<std::uint16_t> values;
  std::vector<std::string> advice;
};

std::string shortened(std::vector<std::string> words) {
  const std::size_t count = words.size();
  if (count > kMostListed) words.resize(kMostListed);
  return fmt::format("{}{}", fmt::join(words, ", "), count > kMostListed ? fmt::format(", … ({})", count) : "");
}

std::string advice_on_axis(const Index& index, std::string_view name) {
  std::vector<std::string> known;
  for (const ArchiveAxis& axis : index.axes) known.push_back(axis.name);
  const std::string nearest = nearest_name(name, known);
  if (!nearest.empty()) return fmt::format("there is no axis '{}'; did you mean '{}'?", name, nearest);
  return fmt::format("there is no axis '{}'; there are {}", name, shortened(std::move(known)));
}

std::string advice_on_value(const ArchiveAxis& axis, std::string_view value) {
  return fmt::format("axis {} has no value '{}'; it has {}", axis.name, value, shortened(axis.values));
}

Wanted resolve(const Index& index, Assignment assignment) {
  Wanted wanted;
  for (const ArchiveAxis& axis : index.axes) wanted.values.push_back(axis.default_value);
  std::vector<bool> given(index.axes.size());
  for (const auto& [name, value] : assignment) {
    const auto axis = std::ranges::find(index.axes, name, &ArchiveAxis::name);
    if (axis == index.axes.end()) {
      wanted.advice.push_back(advice_on_axis(index, name));
      continue;
    }
    const auto at = static_cast<std::size_t>(axis - index.axes.begin());
    if (given[at]) wanted.advice.push_back(fmt::format("axis {} is given twice", name));
    given[at] = true;
    const auto known = std::ranges::find(axis->values, value);
    const bool is_known = known != axis->values.end();
    wanted.values[at] = is_known ? static_cast<std::uint16_t>(known - axis->values.begin()) : kUnknownValue;
    if (!is_known) wanted.advice.push_back(advice_on_value(*axis, value));
  }
  return wanted;
}

/// A permutation that does not have the axis is as one at its default: both have the same key.
bool differs(const ArchiveAxis& axis, std::uint16_t wanted, std::uint16_t value) {
  return wanted != (value == kNoValue ? axis.default_value : value);
}

std::size_t distance(const Index& index, std::span<const std::uint16_t> wanted, std::uint32_t entry) {
  const auto values = index.values_of(entry);
  std::size_t count = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) count += differs(index.axes[i], wanted[i], values[i]);
  return count;
}

/// The first few of those that are nearest.
std::vector<std::uint32_t> nearest_entries(const Index& index, std::span<const std::uint16_t> wanted) {
  std::vector<std::uint32_t> nearest;
  std::size_t best = wanted.size() + 1;
  for (std::uint32_t entry = 0; entry < index.entries.size(); ++entry) {
    const std::size_t count = distance(index, wanted, entry);
    if (count < best) nearest.clear();
    best = std::min(best, count);
    if (count == best && nearest.size() < kMostNearest) nearest.push_back(entry);
  }
  return nearest;
}

std::string describe(const Index& index, std::span<const std::uint16_t> wanted, std::uint32_t entry) {
  const auto values = index.values_of(entry);
  std::vector<std::string> differences;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!differs(index.axes[i], wanted[i], values[i])) continue;
    const std::string_view value = values[i] == kNoValue ? "(none)" : std::string_view(index.axes[i].values[values[i]]);
    differences.push_back(fmt::format("{}: {}", index.axes[i].name, value));
  }
  const std::string name = name_of(index.axes, values);
  return differences.empty() ? name : fmt::format("{} (differs in {})", name, fmt::join(differences, ", "));
}

}  // namespace

std::string explain_missing(const Index& index, Assignment assignment) {
  std::vector<std::string> words;
  for (const auto& [name, value] : assignment) words.push_back(fmt::format("{}={}", name, value));
  if (words.empty()) words.emplace_back("with every axis at its default");
  std::string message = fmt::format("no permutation {}", fmt::join(words, " "));
  const Wanted wanted = resolve(index, assignment);
  for (const std::string& advice : wanted.advice) message += "; " + advice;
  std::vector<std::string> nearest;
  for (const std::uint32_t entry : nearest_entries(index, wanted.values))
    nearest.push_back(describe(index, wanted.values, entry));
  return nearest.empty() ? message + "; the archive is empty"
                         : fmt::format("{}; nearest: {}", message, fmt::join(nearest, ", "));
}

std::vector<std::pair<Target, std::string_view>> absent_targets(const Index& index, std::uint32_t entry) {
  std::vector<std::pair<Target, std::string_view>> list;
  const std::uint32_t number = index.entries[entry].absence;
  if (number == kNone) return list;
  const AbsenceRecord& absence = index.absences[number];
  for (const AbsentTargetRecord& absent : index.absent_targets.subspan(absence.first, absence.count))
    list.emplace_back(index.targets[absent.target], index.string(absent.reason));
  return list;
}

Error explain_no_output(const Index& index, std::uint32_t entry, ShaderStage stage, const Target& target) {
  const std::string name = name_of(index.axes, index.values_of(entry));
  for (const auto& [absent, reason] : absent_targets(index, entry)) {
    if (absent == target)
      return {ErrorCode::unsupported,
              "archive.no-output",
              fmt::format("permutation {} has no {}: {}", name, to_string(target), reason),
              "",
              0,
              0};
  }
  std::vector<std::string> there;
  for (const OutputRecord& output : index.outputs_of(index.programs[index.entries[entry].program]))
    there.push_back(fmt::format("{} {}", to_string(static_cast<ShaderStage>(output.stage)),
                                to_string(index.targets[output.target])));
  return {ErrorCode::usage,
          "archive.no-output",
          fmt::format("permutation {} has no {} shader for {}; it has {}", name, to_string(stage), to_string(target),
                      there.empty() ? "none" : shortened(std::move(there))),
          "",
          0,
          0};
}

}  // namespace relievo::archive
