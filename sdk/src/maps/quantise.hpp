/// Values on their way into a map, in the map's bits.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "relievo/describe.hpp"
#include "relievo/map_texels.hpp"
#include "relievo/result.hpp"

namespace relievo {

/// No values yet, and room for `count` of these bits.
MapTexels::Values make_values(int bits, std::size_t count);

/// Adds values of the map so named, rounded by channel if its bits are 8 or 16; they must lie in [0,1] then, else
/// "maps.range".
Status append_rounded(std::string_view map, std::span<const float> values, std::span<const Rounding> rounding,
                      MapTexels::Values& into);

}  // namespace relievo
