/// Heights as C hands them over.
#pragma once

#include "c_api/boundary.hpp"
#include "relievo/height_map.hpp"

namespace relievo::c_api {

/// Copies width · height floats. Errors: "c.extent", "c.enum" for the address mode, "c.height" for a number that is not
/// in [0,1].
Result<HeightMap> heights_of(const float* heights, std::int32_t width, std::int32_t height,
                             relievo_address_mode address);

}  // namespace relievo::c_api
