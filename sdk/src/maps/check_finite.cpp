#include "maps/check_finite.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace relievo {

Status check_finite(const MapData& map, ErrorCode code, std::string_view id) {
  const auto* floats = std::get_if<std::vector<float>>(&map.texels.values());
  return floats == nullptr ? Status() : check_finite(map.name, *floats, 0, code, id);
}

Status check_finite(std::string_view map, std::span<const float> values, std::size_t first, ErrorCode code,
                    std::string_view id) {
  const auto bad = std::find_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); });
  if (bad == values.end()) return {};
  return fail(code, std::string(id),
              fmt::format("map '{}' has the value {} at element {}; expected a finite number", map, *bad,
                          first + static_cast<std::size_t>(bad - values.begin())));
}

}  // namespace relievo
