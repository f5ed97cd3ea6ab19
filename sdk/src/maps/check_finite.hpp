/// A check on what a map was baked to, or is read as.
#pragma once

#include <string_view>

#include "relievo/maps.hpp"

namespace relievo {

/// No comparison catches a NaN. The error, of this code and id, names the first value that is not finite.
Status check_finite(const MapData& map, ErrorCode code, std::string_view id);

}  // namespace relievo
