/// Maps in 8 and 16 bits that still keep what they promise.
#include "maps/quantise.hpp"

#include <fmt/format.h>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

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
int exact_bits(std::span<const float> values, int bits, std::span<const Rounding> rounding) {
  for (std::size_t i = 0; i < values.size() && bits < 32; ++i) {
    if (rounding[i % rounding.size()] != Rounding::exact) continue;
    auto held = [&](int n) {
      const double most = (1 << n) - 1;
      return values[i] == static_cast<float>(std::round(values[i] * most) / most);
    };
    while (bits < 32 && !held(bits)) bits *= 2;
  }
  return bits;
}

template <class Stored>
Status append(std::string_view map, std::span<const float> values, std::span<const Rounding> rounding,
              std::vector<Stored>& into) {
  const double most = std::numeric_limits<Stored>::max();
  for (const float value : values) {
    if (!(value >= 0 && value <= 1)) {
      return fail(ErrorCode::usage, "maps.range",
                  fmt::format("map '{}' has the value {} at element {}; expected 0 to 1, as {} bits hold", map, value,
                              into.size(), 8 * sizeof(Stored)));
    }
    into.push_back(static_cast<Stored>(rounded(value * most, rounding[into.size() % rounding.size()])));
  }
  return {};
}

Status append(std::string_view, std::span<const float> values, std::span<const Rounding>, std::vector<float>& into) {
  into.insert(into.end(), values.begin(), values.end());
  return {};
}

}  // namespace

MapTexels::Values make_values(int bits, std::size_t count) {
  MapTexels::Values values;
  if (bits == 8) values = std::vector<std::uint8_t>();
  if (bits == 16) values = std::vector<std::uint16_t>();
  std::visit([count](auto& stored) { stored.reserve(count); }, values);
  return values;
}

Status append_rounded(std::string_view map, std::span<const float> values, std::span<const Rounding> rounding,
                      MapTexels::Values& into) {
  return std::visit([&](auto& stored) { return append(map, values, rounding, stored); }, into);
}

Status quantise(MapData& map, int bits, std::span<const Rounding> rounding) {
  if (bits == 32) return {};
  if (bits != 8 && bits != 16) {
    return fail(ErrorCode::usage, "maps.bits",
                fmt::format("map '{}' has {} bits; expected 8, 16 or 32", map.name, bits));
  }
  const std::vector<float> floats = map.texels.floats();
  bits = exact_bits(floats, bits, rounding);
  if (bits == 32) return {};
  MapTexels::Values values = make_values(bits, floats.size());
  if (Status status = append_rounded(map.name, floats, rounding, values); !status) return status;
  map.texels = std::move(values);
  map.bits = bits;
  return {};
}

}  // namespace relievo
