/// Rules on the axes of permutations, in descriptors and in manifests.
#pragma once

#include <string>
#include <vector>

#include "describe/toml_reader.hpp"
#include "relievo/describe.hpp"

namespace relievo {

/// The rules of one [[rule]]: `requires = {filter = "exact"}` and `excludes = {…}`, one rule a condition, each under
/// `when`. A subject without a dot that is no built-in one gets the prefix `owner.`; with an empty owner it stays.
std::vector<Rule> read_rules(TomlReader& table, const std::vector<Condition>& when, const std::string& owner);

/// `{stage = "surface", address = ["clamp", "clip"]}` at `key`.
std::vector<Condition> read_conditions(TomlReader& table, std::string_view key, const std::string& owner);

/// technique, stage, target, address, …: what every permutation has, or may have.
const std::vector<std::string>& built_in_subjects();

}  // namespace relievo
