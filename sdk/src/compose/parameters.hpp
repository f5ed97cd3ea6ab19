/// Gives every loop count and parameter of a permutation its place: macro, specialization constant or uniform.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "relievo/compose.hpp"

namespace relievo {

/// The parameters of one descriptor, under its name.
struct ParameterOwner {
  std::string name;
  const std::vector<Parameter>* parameters = nullptr;
};

/// Slots in the order of owners and declarations. Errors: "compose.unknown-parameter" (nearest given) for a key of
/// `values` or `times` that no owner has, "compose.range", "compose.type".
Result<std::vector<ParameterSlot>> assign_parameters(const std::vector<ParameterOwner>& owners,
                                                     const std::map<std::string, double>& values,
                                                     const std::map<std::string, BindingTime>& times);

/// Size of the Parameters block, a multiple of 16; 0 when no slot is a uniform.
int parameter_block_size(const std::vector<ParameterSlot>& slots);

/// The GLSL that declares every slot as `<owner>_<name>`.
std::string declare_parameters(const std::vector<ParameterSlot>& slots);

}  // namespace relievo
