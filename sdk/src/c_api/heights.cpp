#include "c_api/heights.hpp"

#include <fmt/format.h>

namespace relievo::c_api {

static_assert(RELIEVO_CLIP == static_cast<int>(AddressMode::clip));

namespace {

Status check_extent(std::int32_t width, std::int32_t height) {
  for (const std::int32_t extent : {width, height}) {
    if (extent >= 1 && extent <= max_height_map_extent) continue;
    return fail(
        ErrorCode::usage, "c.extent",
        fmt::format("the heights are {}x{} texels; from 1 to {} are expected", width, height, max_height_map_extent));
  }
  return {};
}

}  // namespace

Result<HeightMap> heights_of(const float* heights, std::int32_t width, std::int32_t height,
                             relievo_address_mode address) {
  if (Status status = check_extent(width, height); !status) return tl::unexpected(status.error());
  if (Status status = require_enum("address", address, RELIEVO_CLIP + 1); !status)
    return tl::unexpected(status.error());
  const std::size_t columns = static_cast<std::size_t>(width), count = columns * static_cast<std::size_t>(height);
  for (std::size_t i = 0; i < count; ++i) {
    if (heights[i] >= 0 && heights[i] <= 1) continue;  // NaN is neither
    return fail(ErrorCode::usage, "c.height",
                fmt::format("the height at ({}, {}) is {}; a number in [0,1] is expected", i % columns, i / columns,
                            heights[i]));
  }
  return HeightMap{width, height, {heights, heights + count}, static_cast<AddressMode>(address)};
}

}  // namespace relievo::c_api
