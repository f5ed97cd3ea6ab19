#include <memory>
#include <utility>
#include <vector>

#include "c_api/boundary.hpp"
#include "c_api/heights.hpp"
#include "c_api/registry.hpp"
#include "relievo/maps.hpp"

struct relievo_map {
  relievo::MapData data;  ///< without its texels
  std::vector<float> texels;
};

namespace relievo::c_api {

static_assert(RELIEVO_FLAT == static_cast<int>(MapDimension::flat));
static_assert(RELIEVO_VOLUME == static_cast<int>(MapDimension::volume));

namespace {

Result<std::unique_ptr<relievo_map>> bake(const relievo_registry& registry, const relievo_bake_desc& desc) {
  Result<HeightMap> heights = heights_of(desc.heights, desc.width, desc.height, desc.address);
  if (!heights) return tl::unexpected(heights.error());
  const Result<std::map<std::string, double>> values = values_of(registry, desc.values, desc.value_count);
  if (!values) return tl::unexpected(values.error());
  const Result<std::unique_ptr<Backend>> backend = open_backend(desc.backend);
  if (!backend) return tl::unexpected(backend.error());
  MapSet maps = map_set(*std::move(heights));
  if (Status status = bake_map(**backend, registry.registry, desc.map, maps, *values); !status)
    return tl::unexpected(status.error());
  MapData& baked = maps.find(desc.map)->second;
  std::vector<float> texels = std::exchange(baked.texels, {}).floats();
  return std::make_unique<relievo_map>(relievo_map{std::move(baked), std::move(texels)});
}

}  // namespace

}  // namespace relievo::c_api

using namespace relievo;
using namespace relievo::c_api;

relievo_status relievo_map_bake(const relievo_registry* registry, const relievo_bake_desc* desc, relievo_map** map,
                                relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"registry", registry}, {"desc", desc}, {"map", map}}); !status) return status;
    if (Status status =
            require({{"desc.map", desc->map}, {"desc.heights", desc->heights}, {"desc.backend", desc->backend}});
        !status)
      return status;
    auto baked = bake(*registry, *desc);
    if (!baked) return tl::unexpected(baked.error());
    *map = baked->release();
    return {};
  });
}

void relievo_map_free(relievo_map* map) {
  delete map;
}

relievo_status relievo_map_get(const relievo_map* map, relievo_map_info* info, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"map", map}, {"info", info}}); !status) return status;
    const MapData& data = map->data;
    *info = {view(data.name),
             data.width,
             data.height,
             data.depth,
             data.channels,
             data.levels,
             data.bits,
             static_cast<relievo_map_dimension>(data.dimension),
             static_cast<relievo_address_mode>(data.address),
             map->texels.data(),
             map->texels.size(),
             data.is_uint};
    return {};
  });
}
