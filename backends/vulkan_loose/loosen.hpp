/// Float arithmetic as inexact as Vulkan permits, by rewriting SPIR-V.
#pragma once

#include <span>

#include "compile/spirv_words.hpp"

namespace relievo {

/// The module with the errors in 32-bit floats that Vulkan permits a driver ("Precision and Operation of SPIR-V
/// Instructions"), where software drivers round correctly. In a way that looks random:
/// Quotients are up to 2.5 ulp off, and 0 for divisors beyond 2^126. Square roots are what 1 / inversesqrt may be, up
/// to 3.5 ulp off, or 4.5 where the mantissa is √2 or more. Denormals that are computed or read from an image are 0,
/// and the sign of a 0 is either. With `has_float64`, which the device must then support, a · b ± c is one operation
/// where neither is NoContraction; a may be a vector. Inverse square roots keep the driver's error, for that may be all
/// that is permitted. SPIR-V that is not valid stays as it is.
SpirvWords loosen(std::span<const std::uint32_t> words, bool has_float64);

}  // namespace relievo
