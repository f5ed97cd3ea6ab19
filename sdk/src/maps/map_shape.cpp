#include <algorithm>
#include <bit>

#include "relievo/maps.hpp"

namespace relievo {

namespace {

/// An integer parameter of the map: the value given, else its default; `fallback` when it has none of that name.
int parameter_of(const MapDescriptor& map, std::string_view name, const std::map<std::string, double>& values,
                 int fallback) {
  const auto found =
      std::find_if(map.parameters.begin(), map.parameters.end(), [&](const Parameter& p) { return p.name == name; });
  if (found == map.parameters.end()) return fallback;
  const auto given = values.find(map.name + "." + found->name);
  return static_cast<int>(given == values.end() ? found->value : given->second);
}

}  // namespace

MapData map_shape(const MapDescriptor& descriptor, int width, int height, AddressMode address,
                  const std::map<std::string, double>& values) {
  MapData map;
  map.name = descriptor.name;
  map.width = width;
  map.height = height;
  map.channels = descriptor.channels;
  map.address = address;
  map.dimension = descriptor.dimension;
  map.depth = parameter_of(descriptor, descriptor.layers_parameter, values, descriptor.layers);
  map.bits = descriptor.rounding.empty() ? 32 : parameter_of(descriptor, "bits", values, 32);
  map.is_uint = descriptor.is_uint;
  if (descriptor.levels == MapLevels::single) return map;
  const int left_out = descriptor.levels == MapLevels::coarse_pyramid ? 2 : 0;
  map.width = std::max(1, static_cast<int>(std::bit_ceil(static_cast<unsigned>(width))) >> left_out);
  map.height = std::max(1, static_cast<int>(std::bit_ceil(static_cast<unsigned>(height))) >> left_out);
  map.levels = std::bit_width(static_cast<unsigned>(std::max(map.width, map.height)));
  return map;
}

}  // namespace relievo
