#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "relievo/height_map.hpp"

namespace relievo {
namespace {

constexpr std::array<std::pair<AddressMode, std::string_view>, 4> address_modes = {{
    {AddressMode::repeat, "repeat"},
    {AddressMode::mirror, "mirror"},
    {AddressMode::clamp, "clamp"},
    {AddressMode::clip, "clip"},
}};

std::int64_t floor_modulo(std::int64_t i, std::int64_t period) {
  const std::int64_t remainder = i % period;
  return remainder < 0 ? remainder + period : remainder;
}

/// The two texels around a coordinate along one axis and the weight of the second.
struct Footprint {
  int first = 0, second = 0;
  double weight = 0;
};

/// Brings `u` to where doubles are dense before it is scaled: the texel coordinate keeps its fraction however far u is.
double near_zero(double u, AddressMode mode) {
  if (!std::isfinite(u)) return 0;
  switch (mode) {
    case AddressMode::repeat:
      return u - std::floor(u);
    case AddressMode::mirror:
      return u - 2 * std::floor(u / 2);
    default:
      return std::clamp(u, -1.0, 2.0);
  }
}

Footprint footprint(double u, int extent, AddressMode mode) {
  const double x = near_zero(u, mode) * extent - 0.5;
  const double cell = std::floor(x);
  const auto i = static_cast<std::int64_t>(cell);
  return {wrap_texel(i, extent, mode), wrap_texel(i + 1, extent, mode), x - cell};
}

}  // namespace

std::string_view to_string(AddressMode mode) {
  for (const auto& [value, name] : address_modes)
    if (value == mode) return name;
  return "unknown";
}

Result<AddressMode> parse_address_mode(std::string_view name) {
  for (const auto& [value, known] : address_modes)
    if (known == name) return value;
  return fail(ErrorCode::usage, "address.unknown",
              fmt::format("address mode is \"{}\", expected repeat, mirror, clamp or clip", name));
}

int wrap_texel(std::int64_t i, int extent, AddressMode mode) {
  const std::int64_t n = extent;
  switch (mode) {
    case AddressMode::repeat:
      return static_cast<int>(floor_modulo(i, n));
    case AddressMode::mirror: {
      const std::int64_t k = floor_modulo(i, 2 * n);
      return static_cast<int>(k < n ? k : 2 * n - 1 - k);
    }
    default:
      return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
  }
}

double sample_height(const HeightMap& map, double u, double v) {
  const Footprint x = footprint(u, map.width, map.address);
  const Footprint y = footprint(v, map.height, map.address);
  const double near = std::lerp(double{map.at(x.first, y.first)}, double{map.at(x.second, y.first)}, x.weight);
  const double far = std::lerp(double{map.at(x.first, y.second)}, double{map.at(x.second, y.second)}, x.weight);
  return std::lerp(near, far, y.weight);
}

}  // namespace relievo
