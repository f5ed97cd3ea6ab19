/// Maps as textures of a Job.
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

}  // namespace

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
  std::size_t count = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
  std::vector<std::byte> bytes(count * static_cast<std::size_t>(stored) * sizeof(float));
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(bytes.data() + i * static_cast<std::size_t>(stored) * sizeof(float),
                map.texels.data() + i * static_cast<std::size_t>(map.channels),
                static_cast<std::size_t>(map.channels) * sizeof(float));
  }
  texture.data.push_back(std::move(bytes));
  return texture;
}

}  // namespace relievo
