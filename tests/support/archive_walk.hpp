/// Every accessor of an archive, whatever it holds.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "relievo/archive.hpp"

namespace relievo::test {

/// What an archive that opened contradicts itself in, or empty: its keys, names, and each output's being there.
inline std::string contradiction_of(const Archive& archive) {
  if (archive.program_count() > archive.size()) return "more programs than permutations";
  for (Archive::Entry entry = 0; entry < archive.size(); ++entry) {
    if (archive.values(entry).size() != archive.axes().size()) return "values are missing";
    if (archive.find(archive.key(entry)) != entry) return "a key does not find its permutation";
    if (archive.program(entry) >= archive.program_count()) return "a program beyond the last";
    std::vector<std::pair<std::string_view, std::string_view>> assignment;
    for (std::size_t axis = 0; axis < archive.axes().size(); ++axis) {
      const ArchiveAxis& of = archive.axes()[axis];
      if (const std::uint16_t value = archive.values(entry)[axis]; value != kNoValue)
        assignment.emplace_back(of.name, of.values.at(value));
    }
    const auto found = archive.find(assignment);
    if (!found || *found != entry) return "an assignment does not find its permutation";
    assignment.emplace_back("no such axis", "x");
    if (archive.find(assignment)) return "an axis that is not there is found";
    if (archive.name(entry).empty()) return "a name is empty";
    bool is_whole = true;
    for (const ArchiveOutput& output : archive.outputs(entry)) {
      const auto bytes = archive.output(entry, output.stage, output.target);
      if (bytes ? bytes->size() != output.size : bytes.error().id != "archive.damaged") return "an output is lost";
      is_whole = is_whole && bytes.has_value();
    }
    is_whole = is_whole && archive.reflection(entry) && archive.cost(entry);
    if (archive.load(entry).has_value() != is_whole) return "a program differs from its parts";
    if (archive.verify() && !is_whole) return "damage is not seen";
    const std::vector<ShaderStage> stages = archive.stages(entry);
    if (stages.empty() != archive.outputs(entry).empty()) return "stages and outputs disagree";
    for (const auto& [target, reason] : archive.absent(entry)) {
      for (const ShaderStage stage : stages) {
        const auto output = archive.output(entry, stage, target);
        if (output || output.error().id != "archive.no-output") continue;  // writers refuse that; opening does not look
        if (output.error().message.find(reason) == std::string::npos)      // the sentence has every byte of the reason
          return "an absent target's reason is not told";
      }
    }
  }
  return {};
}

}  // namespace relievo::test
