#include "maps/check_finite.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace relievo {

Status check_finite(const MapData& map, ErrorCode code, std::string_view id) {
  const auto bad =
      std::find_if(map.texels.begin(), map.texels.end(), [](float value) { return !std::isfinite(value); });
  if (bad == map.texels.end()) return {};
  return fail(code, std::string(id),
              fmt::format("map '{}' has the value {} at element {}; expected a finite number", map.name, *bad,
                          bad - map.texels.begin()));
}

}  // namespace relievo
