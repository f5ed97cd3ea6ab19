/// Specialization constants made ordinary ones, without parsing again.
#pragma once

#include <cstdint>
#include <span>

#include "compile/spirv_words.hpp"

namespace relievo {

/// A value for the specialization constant with this `constant_id`: the bits of an int or a float.
struct FrozenConstant {
  int id = 0;
  std::uint32_t bits = 0;
  friend bool operator==(const FrozenConstant&, const FrozenConstant&) = default;
};

/// The module in which these constants have these values for good; those that it does not have do not matter.
SpirvWords freeze(std::span<const std::uint32_t> words, std::span<const FrozenConstant> constants);

}  // namespace relievo
