/// Specialization constants in emitted GLSL are macros with a default; here they get the program's values.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "relievo/job.hpp"

namespace relievo::opengl {

/// SPIRV-Cross writes `#ifndef SPIRV_CROSS_CONSTANT_ID_3 / #define SPIRV_CROSS_CONSTANT_ID_3 0.5`. Returns the source
/// with the values defined after its #version and #extension lines, as literals of the type that the source gives
/// the constant; line numbers in the driver's log stay those of `source`. Constants that it does not use are left out.
std::string specialize(std::string_view source, const std::vector<SpecializationValue>& constants);

}  // namespace relievo::opengl
