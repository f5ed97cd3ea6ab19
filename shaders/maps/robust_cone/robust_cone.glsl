// (M, A, √s) of a cell, as shaders/lib/cone.glsl has them; `folded` as relievo_fold_cell gives it.
#include "shaders/lib/fold.glsl"

vec3 relievo_robust_cone_at(FoldedCell folded) {
  RELIEVO_COUNT_FETCHES(1);
  return texelFetch(relievo_robust_cone_map, ivec2(folded.cell), 0).rgb;
}
