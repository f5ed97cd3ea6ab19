// The greatest heights over the windows of a cell, smallest first; cell and heading as relievo_fold_cell gives them.
#include "shaders/lib/fold.glsl"

vec4 relievo_quadrant_maxima_at(FoldedCell folded) {
  RELIEVO_COUNT_FETCHES(1);
  return texelFetch(relievo_quadrant_maxima_map, ivec3(ivec2(folded.cell), relievo_quadrant(folded.heading)), 0);
}

// Their widths in cells.
vec4 relievo_quadrant_maxima_widths() {
  const float first = float(quadrant_maxima_first), ratio = float(quadrant_maxima_ratio);
  return vec4(1.0, first, first * ratio, first * ratio * ratio);
}
