/// Maps as textures of a Job.
#include <algorithm>
#include <array>
#include <cstring>
#include <variant>

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

/// The texels of a level, of `stored` channels each in the texture; those that the map has not are 0.
template <class Value>
std::vector<std::byte> level_bytes(const std::vector<Value>& values, const MapData& map, const MapLevel& level,
                                   std::size_t stored) {
  const std::size_t count = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height) *
                            static_cast<std::size_t>(map.depth);
  const std::size_t channels = static_cast<std::size_t>(map.channels);
  const Value* first = values.data() + level.offset * channels;
  std::vector<std::byte> bytes(count * stored * sizeof(Value));
  if (stored == channels) {
    std::memcpy(bytes.data(), first, bytes.size());
    return bytes;
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&bytes[i * stored * sizeof(Value)], first + i * channels, channels * sizeof(Value));
  }
  return bytes;
}

std::vector<std::vector<std::byte>> all_bytes(const MapTexels& texels, const MapData& map, std::size_t stored) {
  std::vector<std::vector<std::byte>> levels;
  for (int k = 0; k < map.levels; ++k) {
    levels.push_back(std::visit([&](const auto& values) { return level_bytes(values, map, map_level(map, k), stored); },
                                texels.values()));
  }
  return levels;
}

Format map_format(const MapData& map, std::size_t stored) {
  if (map.is_uint) return Format::rgba16_uint;
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

MapSet map_set(HeightMap height_map) {
  MapSet maps;
  maps["height"] = {"height", height_map.width, height_map.height, 1, std::move(height_map.texels), height_map.address};
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
  if (map.is_uint) texture.sampler.min_mag = TexelFilter::nearest;
  texture.levels = map.levels;
  if (map.texels.bits() == map.bits) {
    texture.data = all_bytes(map.texels, map, stored);
  } else {
    texture.data = all_bytes(MapTexels(map.texels.floats(), map.bits), map, stored);
  }
  return texture;
}

}  // namespace relievo
