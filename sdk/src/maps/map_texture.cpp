/// Maps as textures of a Job.
#include <algorithm>
#include <cstring>

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

std::vector<std::byte> level_bytes(const MapData& map, const MapLevel& level, int stored) {
  std::size_t count = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height);
  std::size_t channels = static_cast<std::size_t>(map.channels),
              stride = static_cast<std::size_t>(stored) * sizeof(float);
  std::vector<std::byte> bytes(count * stride);
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(bytes.data() + i * stride, map.texels.data() + (level.offset + i) * channels, channels * sizeof(float));
  }
  return bytes;
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

Texture map_texture(const MapData& map) {
  int stored = map.channels == 3 ? 4 : map.channels;
  Texture texture;
  texture.name = map.name;
  texture.format = stored == 1 ? Format::r32_float : stored == 2 ? Format::rg32_float : Format::rgba32_float;
  texture.width = map.width;
  texture.height = map.height;
  texture.sampler.address.fill(texel_address(map.address));
  texture.levels = map.levels;
  for (int k = 0; k < map.levels; ++k) texture.data.push_back(level_bytes(map, map_level(map, k), stored));
  return texture;
}

}  // namespace relievo
