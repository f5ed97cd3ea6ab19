// The least (x) and greatest (y) height of the cells that are at most dilation_erosion_radius away from a cell, through the
// borders of the tile too.
#include "shaders/lib/ray.glsl"

vec2 relievo_dilation_erosion_at(ivec2 cell) {
  RELIEVO_COUNT_FETCHES(1);
  return texelFetch(relievo_dilation_erosion_map, cell, 0).rg;
}
