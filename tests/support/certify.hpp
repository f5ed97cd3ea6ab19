/// Baking and certifying in tests.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "relievo/certify.hpp"
#include "support/height_maps.hpp"
#include "support/pipeline.hpp"
#include "support/rotate_texels.hpp"

namespace relievo::test {

/// The map as Vulkan, or the backend that is named, bakes it; or an empty one and a failure.
inline MapData baked(const HeightMap& height_map, const std::string& name,
                     const std::map<std::string, double>& values = {}, const std::string& on = "vulkan") {
  MapSet maps = map_set(height_map);
  std::vector<std::string> messages;
  const Status status = bake_map(backend(on), registry(), name, maps, values, &messages);
  EXPECT_TRUE(status) << name << ": " << (status ? "" : format(status.error()));
  EXPECT_THAT(messages, ::testing::IsEmpty()) << name;
  return status ? maps.at(name) : MapData{};
}

inline CertifyOptions certify_options(const std::map<std::string, double>& values) {
  CertifyOptions options;
  options.values = values;
  return options;
}

/// The certificate, or an empty one and a failure.
inline Certificate certified(const HeightMap& height_map, const MapData& map,
                             const std::map<std::string, double>& values = {}) {
  const Result<Certificate> certificate = certify(height_map, map, certify_options(values));
  EXPECT_TRUE(certificate) << (certificate ? "" : format(certificate.error()));
  return certificate ? *certificate : Certificate{};
}

/// The small maps with every address mode.
inline std::vector<NamedMap> addressed_maps() {
  std::vector<NamedMap> maps;
  for (const NamedMap& base : small_maps()) {
    for (AddressMode mode : all_address_modes)
      maps.push_back({base.name + " " + std::string(to_string(mode)), with_address(base.map, mode)});
  }
  return maps;
}

/// Element of `channel` at texel (x, y) of a level, or of a layer of a 3D map.
inline std::size_t element(const MapData& map, int x, int y, int channel = 0, int level = 0, int layer = 0) {
  const MapLevel shape = map_level(map, level);
  const auto row = static_cast<std::size_t>(layer * shape.height + y);
  const std::size_t texel = shape.offset + row * static_cast<std::size_t>(shape.width) + static_cast<std::size_t>(x);
  return texel * static_cast<std::size_t>(map.channels) + static_cast<std::size_t>(channel);
}

/// Every value to the nearest multiple of 1/255: what a careless quantisation does to a promise.
inline MapData rounded_to_nearest(MapData map) {
  const std::vector<Rounding> nearest(static_cast<std::size_t>(map.channels), Rounding::nearest);
  EXPECT_TRUE(quantise(map, 8, nearest));
  return map;
}

/// A place on the surface, in cells from the centre of texel 0, and its height.
struct SurfacePoint {
  double x = 0, y = 0, height = 0;
};

/// Within [-1/2, extent - 1/2]²: the map itself, its seams included.
inline SurfacePoint surface_point(const HeightMap& map, double x, double y) {
  return {x, y, sample_height(map, (x + 0.5) / map.width, (y + 0.5) / map.height)};
}

inline SurfacePoint random_surface_point(const HeightMap& map, Random& random) {
  return surface_point(map, random.uniform(-0.5, map.width - 0.5), random.uniform(-0.5, map.height - 0.5));
}

/// The cell that a search reads at a coordinate: with repeat cell -1 is the last one, else the first.
inline int cell_read_at(double coordinate, int extent, AddressMode mode) {
  const int cell = static_cast<int>(std::floor(coordinate));
  if (cell >= 0) return cell;
  return mode == AddressMode::repeat ? extent - 1 : 0;
}

}  // namespace relievo::test
