#include "maps/certifiers.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "relievo/describe.hpp"

namespace relievo {

namespace {

/// Our own descriptors need no registry: certifying is asked for without one.
Result<MapDescriptor> embedded_map(std::string_view map) {
  const std::string ending = fmt::format("maps/{}/map.toml", map);
  for (const auto& [path, text] : embedded_sources()) {
    if (path.ends_with(ending)) return parse_map(text, path);
  }
  return fail(ErrorCode::usage, "certify.unknown", fmt::format("map '{}' has no descriptor of our own", map));
}

}  // namespace

Result<double> baked_value(const CertifyOptions& options, std::string_view map, std::string_view parameter) {
  Result<MapDescriptor> descriptor = embedded_map(map);
  if (!descriptor) return tl::unexpected(descriptor.error());
  const std::string name = fmt::format("{}.{}", map, parameter);
  const auto known = std::find_if(descriptor->parameters.begin(), descriptor->parameters.end(),
                                  [&](const Parameter& p) { return p.name == parameter; });
  if (known == descriptor->parameters.end())
    return fail(ErrorCode::usage, "certify.parameter", fmt::format("parameter '{}' is unknown", name));
  const auto given = options.values.find(name);
  const double value = given == options.values.end() ? known->value : given->second;
  const bool whole = !known->is_integer || value == std::floor(value);
  if (whole && value >= known->minimum && value <= known->maximum) return value;
  return fail(ErrorCode::usage, "certify.parameter",
              fmt::format("{} is {}; expected {}{} to {}", name, value, known->is_integer ? "a whole number, " : "",
                          known->minimum, known->maximum));
}

HeightRange cell_range(const HeightMap& height_map, int x, int y) {
  const int x0 = wrap_texel(x, height_map.width, height_map.address);
  const int x1 = wrap_texel(x + 1, height_map.width, height_map.address);
  const int y0 = wrap_texel(y, height_map.height, height_map.address);
  const int y1 = wrap_texel(y + 1, height_map.height, height_map.address);
  const auto [low, high] =
      std::minmax({height_map.at(x0, y0), height_map.at(x1, y0), height_map.at(x0, y1), height_map.at(x1, y1)});
  return {low, high};
}

}  // namespace relievo
