/// Certifying: what a map promises, checked texel by texel on the CPU, in double, against the bilinear surface.
/// Every function here is thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/height_map.hpp"
#include "relievo/maps.hpp"

namespace relievo {

struct CertifyOptions {
  std::map<std::string, double> values;  ///< parameters that the map was baked with, "map.parameter"
  double tolerance = 0;                  ///< a promise broken by no more than this, in the promise's own unit, is kept
  unsigned threads = 0;                  ///< 0 = all
};

/// How well one map keeps its promise.
struct Certificate {
  std::string map;
  std::string promise;     ///< what was checked, one sentence with its unit
  bool guaranteed = true;  ///< false: the paper's map breaks it in places, and a violation is no fault of ours
  std::uint64_t checked = 0, violations = 0;
  double worst = 0;                        ///< by how much the promise is broken at the worst texel; 0 if nowhere
  int x = 0, y = 0, level = 0, layer = 0;  ///< the worst texel
};

/// Checks `map` against the bilinear surface of `height_map`.
/// Errors: "certify.unknown" for a map without a certifier, "certify.shape" when extent, levels, layers or channels are
/// not those of the height map's map, "certify.parameter" for a value out of its range, "certify.non-finite" for a map
/// with NaN or Inf.
Result<Certificate> certify(const HeightMap& height_map, const MapData& map, const CertifyOptions& options = {});

/// Names of the maps that can be certified, sorted.
std::vector<std::string> certified_maps();

/// What a map's folder provides in `certify.cpp`: `extern const Certifier relievo::certifiers::<folder name>;`
struct Certifier {
  const char* promise;
  /// Fills checked, violations, worst and where.
  Status (*check)(const HeightMap&, const MapData&, const CertifyOptions&, Certificate&);
  bool guaranteed = true;
};

}  // namespace relievo
