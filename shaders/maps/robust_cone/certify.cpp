/// Nothing within reach pokes out of a cell's cone.
#include "maps/certify_cones.hpp"

namespace relievo::certifiers {

namespace {

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  return check_cones(height_map, map, false, options, certificate);
}

}  // namespace

extern const Certifier robust_cone;
const Certifier robust_cone = {"no corner of a cell within reach is above the cone (H)", check};

}  // namespace relievo::certifiers
