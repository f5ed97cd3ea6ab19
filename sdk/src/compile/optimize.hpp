/// SPIRV-Tools: validation and optimization.
#pragma once

#include <string_view>

#include "compile/spirv_words.hpp"
#include "relievo/result.hpp"

namespace relievo {

/// spirv-val for Vulkan 1.0. Errors: "compile.spirv-invalid" with the validator's own words; `when` names the step.
Status validate_spirv(const SpirvWords& words, std::string_view permutation_key, std::string_view when);

/// Inlines and removes what is dead or redundant; float arithmetic stays as written. Names, bindings in use and
/// specialization constants in use are kept. Errors: "compile.spirv-invalid" when the module cannot be read.
Result<SpirvWords> optimize_spirv(const SpirvWords& words, std::string_view permutation_key);

}  // namespace relievo
