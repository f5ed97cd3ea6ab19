/// Maps in 8 and 16 bits that still keep what they promise.
#include <fmt/format.h>
#include <cmath>

#include "relievo/maps.hpp"

namespace relievo {

namespace {

double rounded(double scaled, Rounding rounding) {
  switch (rounding) {
    case Rounding::up:
      return std::ceil(scaled);
    case Rounding::down:
      return std::floor(scaled);
    default:
      return std::round(scaled);
  }
}

/// The fewest bits, from `bits` on, in which the channels that are to be exact are.
int exact_bits(const MapData& map, int bits, std::span<const Rounding> rounding) {
  const std::size_t channels = static_cast<std::size_t>(map.channels);
  for (std::size_t i = 0; i < map.texels.size() && bits < 32; ++i) {
    if (rounding[i % channels] != Rounding::exact) continue;
    auto held = [&](int n) {
      const double most = (1 << n) - 1;
      return map.texels[i] == static_cast<float>(std::round(map.texels[i] * most) / most);
    };
    while (bits < 32 && !held(bits)) bits *= 2;
  }
  return bits;
}

}  // namespace

Status quantise(MapData& map, int bits, std::span<const Rounding> rounding) {
  if (bits == 32) return {};
  if (bits != 8 && bits != 16) {
    return fail(ErrorCode::usage, "maps.bits",
                fmt::format("map '{}' has {} bits; expected 8, 16 or 32", map.name, bits));
  }
  bits = exact_bits(map, bits, rounding);
  if (bits == 32) return {};
  const double most = (1 << bits) - 1;
  for (std::size_t i = 0; i < map.texels.size(); ++i) {
    const double value = map.texels[i];
    if (!(value >= 0 && value <= 1)) {
      return fail(ErrorCode::usage, "maps.range",
                  fmt::format("map '{}' has the value {} at element {}; expected 0 to 1, as {} bits hold", map.name,
                              value, i, bits));
    }
    const Rounding way = rounding[i % static_cast<std::size_t>(map.channels)];
    map.texels[i] = static_cast<float>(rounded(value * most, way) / most);
  }
  map.bits = bits;
  return {};
}

}  // namespace relievo
