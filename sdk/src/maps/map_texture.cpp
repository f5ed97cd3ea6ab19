/// Maps as textures of a Job.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "relievo/maps.hpp"

namespace relievo {

namespace {

TexelAddress texel_address(AddressMode mode) {
  switch (mode) {
    case AddressMode::repeat:
      return TexelAddress::repeat;
    case AddressMode::mirror:
      return TexelAddress::mirror;
    default:
      return TexelAddress::clamp;
  }
}

/// What one value is in the texture; a quantised one is a whole multiple already.
template <class Stored>
Stored stored_value(float value) {
  if constexpr (std::is_same_v<Stored, float>) return value;
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): no value is negative
  return static_cast<Stored>(value * static_cast<float>(std::numeric_limits<Stored>::max()) + 0.5f);
}

template <class Stored>
std::vector<std::byte> level_bytes(const MapData& map, const MapLevel& level, std::size_t stored) {
  const std::size_t count = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height) *
                            static_cast<std::size_t>(map.depth);
  const std::size_t channels = static_cast<std::size_t>(map.channels);
  const float* values = map.texels.data() + level.offset * channels;
  if (std::is_same_v<Stored, float> && stored == channels) {
    const auto* first = reinterpret_cast<const std::byte*>(values);
    return {first, first + count * channels * sizeof(float)};
  }
  std::vector<std::byte> bytes(count * stored * sizeof(Stored));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < channels; ++c) {
      const Stored value = stored_value<Stored>(values[i * channels + c]);
      std::memcpy(&bytes[(i * stored + c) * sizeof(Stored)], &value, sizeof(Stored));
    }
  }
  return bytes;
}

std::vector<std::byte> level_bytes(const MapData& map, const MapLevel& level, std::size_t stored) {
  if (map.bits == 8) return level_bytes<std::uint8_t>(map, level, stored);
  if (map.bits == 16) return level_bytes<std::uint16_t>(map, level, stored);
  return level_bytes<float>(map, level, stored);
}

Format map_format(const MapData& map, std::size_t stored) {
  constexpr std::array<std::array<Format, 3>, 3> formats = {{
      {Format::r8_unorm, Format::rg8_unorm, Format::rgba8_unorm},
      {Format::r16_unorm, Format::rg16_unorm, Format::rgba16_unorm},
      {Format::r32_float, Format::rg32_float, Format::rgba32_float},
  }};
  return formats[map.bits == 8 ? 0 : map.bits == 16 ? 1 : 2][stored == 1 ? 0 : stored == 2 ? 1 : 2];
}

}  // namespace

MapLevel map_level(const MapData& map, int level) {
  MapLevel result{map.width, map.height, 0};
  for (int k = 0; k < level; ++k) {
    result.offset += static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height);
    result.width = std::max(1, result.width / 2);
    result.height = std::max(1, result.height / 2);
  }
  return result;
}

MapSet map_set(const HeightMap& height_map) {
  MapSet maps;
  maps["height"] = {"height", height_map.width, height_map.height, 1, height_map.texels, height_map.address};
  return maps;
}

std::size_t texel_count(const MapData& map) {
  return map_level(map, map.levels).offset * static_cast<std::size_t>(map.depth);
}

std::size_t texture_bytes(const MapData& map) {
  const std::size_t stored = map.channels == 3 ? 4 : static_cast<std::size_t>(map.channels);
  return texel_count(map) * stored * static_cast<std::size_t>(map.bits) / 8;
}

Texture map_texture(const MapData& map) {
  const std::size_t stored = map.channels == 3 ? 4 : static_cast<std::size_t>(map.channels);
  Texture texture;
  texture.name = map.name;
  texture.format = map_format(map, stored);
  texture.width = map.width;
  texture.height = map.height;
  texture.depth = map.depth;
  texture.is_3d = map.dimension == MapDimension::volume;
  texture.is_array = map.dimension == MapDimension::array;
  texture.sampler.address.fill(texel_address(map.address));
  texture.sampler.address[2] = TexelAddress::clamp;
  texture.levels = map.levels;
  for (int k = 0; k < map.levels; ++k) texture.data.push_back(level_bytes(map, map_level(map, k), stored));
  return texture;
}

}  // namespace relievo
