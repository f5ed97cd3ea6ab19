/// Float arithmetic as inexact as Vulkan permits, by rewriting SPIR-V.
#pragma once

#include <span>

#include "compile/spirv_words.hpp"

namespace relievo {

/// A module that computes the same with what a driver may do to 32-bit floats (Vulkan, "Precision and Operation of
/// SPIR-V Instructions"), where software drivers round correctly:
///  - a quotient is up to 2.5 ulp off, a square root what 1 / inversesqrt may be, in a way that looks random;
///  - denormals that are computed or read from an image are 0, and the sign of a 0 is either;
///  - with `has_float64`, which the device must then support, a · b ± c is one operation where neither is
///  NoContraction.
/// Inverse square roots keep the driver's error, for that may be all that is permitted.
/// What cannot be read as SPIR-V stays as it is.
SpirvWords loosen(std::span<const std::uint32_t> words, bool has_float64);

}  // namespace relievo
