/// From C's description of a program to a permutation.
#pragma once

#include "relievo.h"
#include "relievo/compile.hpp"

namespace relievo::c_api {

/// Errors: "c.null", "c.enum", and an unknown stage.
Result<Permutation> permutation_of(const Registry& registry, const relievo_program_desc& desc);

/// Errors: "c.null", "compile.unknown-target".
Result<std::vector<Target>> targets_of(const relievo_program_desc& desc);

}  // namespace relievo::c_api
