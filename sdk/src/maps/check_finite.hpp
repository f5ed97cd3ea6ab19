/// A check on what a map was baked to, or is read as.
#pragma once

#include <span>
#include <string_view>

#include "relievo/maps.hpp"

namespace relievo {

/// No comparison catches a NaN. The error, of this code and id, names the first value that is not finite.
Status check_finite(const MapData& map, ErrorCode code, std::string_view id);
/// The same for values of the map so named, from its element `first` on.
Status check_finite(std::string_view map, std::span<const float> values, std::size_t first, ErrorCode code,
                    std::string_view id);

}  // namespace relievo
