#include "relievo/certify.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "maps/certifiers.hpp"
#include "maps/check_finite.hpp"

namespace relievo {

Result<Certificate> certify(const HeightMap& height_map, const MapData& map, const CertifyOptions& options) {
  const auto& known = certifiers::all();
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const auto& entry) { return entry.first == map.name; });
  if (found == known.end()) {
    return fail(ErrorCode::usage, "certify.unknown",
                fmt::format("map '{}' has no certifier; expected {}", map.name, fmt::join(certified_maps(), ", ")));
  }
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance)) {
    return fail(ErrorCode::usage, "certify.tolerance",
                fmt::format("the tolerance is {}; expected a finite number that is not negative", options.tolerance));
  }
  Certificate certificate;
  certificate.map = map.name;
  certificate.promise = found->second->promise;
  certificate.guaranteed = found->second->guaranteed;
  if (Status status = check_finite(map, ErrorCode::usage, "certify.non-finite"); !status)
    return tl::unexpected(status.error());
  if (Status status = found->second->check(height_map, map, options, certificate); !status)
    return tl::unexpected(status.error());
  return certificate;
}

std::vector<std::string> certified_maps() {
  std::vector<std::string> names;
  for (const auto& [name, certifier] : certifiers::all()) names.emplace_back(name);
  return names;
}

Status expect_shape(const MapData& map, const MapData& expected) {
  auto shape = [](const MapData& m) { return std::array{m.width, m.height, m.depth, m.levels, m.channels}; };
  if (shape(map) == shape(expected) && map.texels.size() == texel_count(map) * static_cast<std::size_t>(map.channels))
    return {};
  auto text = [](const MapData& m) {
    return fmt::format("{}x{}x{} texels, {} levels, {} channels", m.width, m.height, m.depth, m.levels, m.channels);
  };
  return fail(ErrorCode::usage, "certify.shape",
              fmt::format("map '{}' has {}; expected {}", map.name, text(map), text(expected)));
}

Status expect_pyramid(const MapData& map, const HeightMap& height_map, MapLevels levels, int channels) {
  MapDescriptor descriptor;
  descriptor.levels = levels;
  descriptor.channels = channels;
  return expect_shape(map, map_shape(descriptor, height_map.width, height_map.height, height_map.address));
}

std::size_t first_value(const MapData& map, int x, int y, int level) {
  const MapLevel shape = map_level(map, level);
  const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(shape.width);
  return (shape.offset + row + static_cast<std::size_t>(x)) * static_cast<std::size_t>(map.channels);
}

void count_check(Certificate& certificate, double excess, double tolerance, int x, int y, int level, int layer) {
  ++certificate.checked;
  if (!(excess > tolerance)) return;
  ++certificate.violations;
  if (excess <= certificate.worst) return;
  certificate.worst = excess;
  certificate.x = x;
  certificate.y = y;
  certificate.level = level;
  certificate.layer = layer;
}

void merge(Certificate& into, const Certificate& part) {
  into.checked += part.checked;
  into.violations += part.violations;
  if (part.worst <= into.worst) return;
  into.worst = part.worst;
  into.x = part.x;
  into.y = part.y;
  into.level = part.level;
  into.layer = part.layer;
}

}  // namespace relievo
