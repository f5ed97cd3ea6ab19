#include <functional>
#include <stdexcept>

#include "evaluation/hard_cases.hpp"
#include "evaluation/synthetic_maps.hpp"

namespace relievo::cli {

namespace {

using namespace synthetic;

struct MapKind {
  std::string_view name;
  std::vector<std::string_view> keys;
  std::function<HeightMap(const HardMap&)> make;
};

HeightMap wall(const HardMap& m) {
  return make_map(m.width, m.height,
                  [&](int i, int j) { return (m.along_v ? i == m.width / 2 : j == m.height / 2) ? 1.0 : 0.0; });
}

/// Falls into the middle: every ray that leaves it rises.
HeightMap bowl(const HardMap& m) {
  return make_map(m.width, m.height, [&](int i, int j) {
    const double x = 2 * (i + 0.5) / m.width - 1, y = 2 * (j + 0.5) / m.height - 1;
    return 0.5 * (x * x + y * y);
  });
}

const std::vector<MapKind>& kinds() {
  static const std::vector<MapKind> list = {
      {"bowl", {}, bowl},
      {"checker", {}, [](const HardMap& m) { return checker_map(m.width, m.height); }},
      {"constant", {"value"}, [](const HardMap& m) { return constant_map(m.width, m.height, m.value); }},
      {"noise",
       {"seed"},
       [](const HardMap& m) { return white_noise_map(m.width, m.height, static_cast<std::uint64_t>(m.seed)); }},
      {"plateau", {}, [](const HardMap& m) { return plateau_map(m.width, m.height); }},
      {"ramp", {}, [](const HardMap& m) { return ramp_map(m.width, m.height); }},
      {"ridge",
       {"period", "along"},
       [](const HardMap& m) { return ridge_map(m.width, m.height, m.along_v, m.period); }},
      {"smooth",
       {"seed"},
       [](const HardMap& m) { return smooth_noise_map(m.width, m.height, static_cast<std::uint64_t>(m.seed)); }},
      {"specks",
       {"seed"},
       [](const HardMap& m) { return specks_map(m.width, m.height, static_cast<std::uint64_t>(m.seed)); }},
      {"spike", {}, [](const HardMap& m) { return spike_map(m.width, m.height); }},
      {"staircase", {"steps"}, [](const HardMap& m) { return staircase_map(m.width, m.height, m.steps); }},
      {"wall", {"along"}, wall},
  };
  return list;
}

const MapKind& kind_of(std::string_view name) {
  for (const MapKind& kind : kinds()) {
    if (kind.name == name) return kind;
  }
  throw std::logic_error("map kinds are checked when a case is read");
}

}  // namespace

std::vector<std::string_view> hard_map_kinds() {
  std::vector<std::string_view> names;
  for (const MapKind& kind : kinds()) names.push_back(kind.name);
  return names;
}

std::vector<std::string_view> hard_map_keys(std::string_view kind) {
  return kind_of(kind).keys;
}

HeightMap make_hard_map(const HardMap& map, AddressMode address) {
  HeightMap result = kind_of(map.kind).make(map);
  for (float& texel : result.texels) {
    double t = texel;
    if (map.terraces > 0) t = std::round(t * map.terraces) / map.terraces;
    texel = static_cast<float>(map.low + (map.high - map.low) * t);
  }
  result.address = address;
  return result;
}

}  // namespace relievo::cli
