// (M, A, √s) of a cell, as shaders/lib/cone.glsl has them, for the rays of one sector; `folded` as relievo_fold_cell gives it.
#include "shaders/lib/sector.glsl"

vec3 relievo_directional_cone_at(FoldedCell folded, int slice) {
  RELIEVO_COUNT_FETCHES(1);
  int layer = relievo_sector_layer(folded.heading, slice);
  return texelFetch(relievo_directional_cone_map, ivec3(ivec2(folded.cell), layer), 0).rgb;
}
