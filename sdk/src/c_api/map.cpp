#include <fmt/format.h>

#include <memory>

#include "c_api/boundary.hpp"
#include "c_api/registry.hpp"
#include "relievo/maps.hpp"

struct relievo_map {
  relievo::MapData data;
};

namespace relievo::c_api {

static_assert(RELIEVO_FLAT == static_cast<int>(MapDimension::flat));
static_assert(RELIEVO_VOLUME == static_cast<int>(MapDimension::volume));

namespace {

Status check_extent(const relievo_bake_desc& desc) {
  for (const int extent : {desc.width, desc.height}) {
    if (extent >= 1 && extent <= max_height_map_extent) continue;
    return fail(ErrorCode::usage, "c.extent",
                fmt::format("the heights are {}x{} texels; from 1 to {} are expected", desc.width, desc.height,
                            max_height_map_extent));
  }
  return {};
}

Result<HeightMap> heights_of(const relievo_bake_desc& desc) {
  if (Status status = check_extent(desc); !status) return tl::unexpected(status.error());
  if (Status status = require_enum("address", desc.address, RELIEVO_CLIP + 1); !status)
    return tl::unexpected(status.error());
  const std::size_t count = static_cast<std::size_t>(desc.width) * static_cast<std::size_t>(desc.height);
  for (std::size_t i = 0; i < count; ++i) {
    if (desc.heights[i] >= 0 && desc.heights[i] <= 1) continue;  // NaN is neither
    return fail(ErrorCode::usage, "c.height",
                fmt::format("the height at ({}, {}) is {}; a number in [0,1] is expected",
                            i % static_cast<std::size_t>(desc.width), i / static_cast<std::size_t>(desc.width),
                            desc.heights[i]));
  }
  return HeightMap{
      desc.width, desc.height, {desc.heights, desc.heights + count}, static_cast<AddressMode>(desc.address)};
}

Result<std::unique_ptr<relievo_map>> bake(const Registry& registry, const relievo_bake_desc& desc) {
  const Result<HeightMap> heights = heights_of(desc);
  if (!heights) return tl::unexpected(heights.error());
  const Result<std::map<std::string, double>> values = values_of(desc.values, desc.value_count);
  if (!values) return tl::unexpected(values.error());
  const Result<std::unique_ptr<Backend>> backend = open_backend(desc.backend);
  if (!backend) return tl::unexpected(backend.error());
  MapSet maps = map_set(*heights);
  if (Status status = bake_map(**backend, registry, desc.map, maps, *values); !status)
    return tl::unexpected(status.error());
  return std::make_unique<relievo_map>(relievo_map{std::move(maps.find(desc.map)->second)});
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
    auto baked = bake(registry->registry, *desc);
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
             data.texels.data(),
             data.texels.size()};
    return {};
  });
}
