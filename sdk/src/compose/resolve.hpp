/// What one permutation is made of, after all names are resolved.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "compose/parameters.hpp"
#include "relievo/compose.hpp"

namespace relievo {

template <class T>
void add_once(std::vector<T>& list, const std::type_identity_t<T>& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

struct Parts {
  const StageDescriptor* stage = nullptr;
  std::map<std::string, const TechniqueDescriptor*> roles;
  std::vector<const TechniqueDescriptor*> techniques;  ///< without repetition
  std::vector<const MapDescriptor*> maps;              ///< by set and binding
  std::vector<ParameterSlot> parameters;               ///< of the stage, the techniques, then the maps
};

/// Errors: unknown names, a role without a technique, and those of `assign_parameters`.
Result<Parts> resolve(const Registry& registry, const Permutation& permutation);

/// The second half of `compose`: the texts, with the values that `parts` has. Checks no rules.
Result<ComposedProgram> compose_parts(const Registry& registry, const Permutation& permutation, const Parts& parts);

FeatureSet features_of(const Parts& parts);

/// What rules ask about; "target" is not known here.
Facts facts_of(const Parts& parts, const Permutation& permutation);

/// The first rule of the parts' axes that the facts break, or null.
const Rule* broken_rule(const Parts& parts, const Facts& facts);

/// Adds the maps by name, each once. Errors: "describe.unknown-map".
Status add_maps(const Registry& registry, const std::vector<std::string>& names,
                std::vector<const MapDescriptor*>& maps);
void sort_by_binding(std::vector<const MapDescriptor*>& maps);

}  // namespace relievo
