/// Nothing within reach of a sector's rays pokes out of a cell's cone.
#include "maps/certify_cones.hpp"

namespace relievo::certifiers {

namespace {

Status check(const HeightMap& height_map, const MapData& map, const CertifyOptions& options, Certificate& certificate) {
  return check_cones(height_map, map, true, options, certificate);
}

}  // namespace

extern const Certifier directional_cone;
const Certifier directional_cone = {"no corner of a cell that the sector's rays reach is above the cone (H)", check};

}  // namespace relievo::certifiers
