// What lies ahead of a cell, for rays that head for one quadrant.
#include "shaders/lib/fold.glsl"

struct QuadrantMaxima {
  vec4 windows;  // greatest heights over the windows, smallest first
  vec4 corners;  // of the cell: near, across in u, across in v, far
};

// What stands for a height of 1. A corner is never 0 but 1/255 at least.
const float RELIEVO_QUADRANT_WINDOW_UNIT = 255.0;
const float RELIEVO_QUADRANT_CORNER_UNIT = 255.0 / 256.0;

// A channel holds a window's byte above a corner's: as a whole and a fraction.
QuadrantMaxima relievo_quadrant_maxima_at(ivec2 cell, int quadrant) {
  RELIEVO_COUNT_FETCHES(1);
#if quadrant_maxima_fetch == quadrant_maxima_fetch_image
  vec4 texel = imageLoad(relievo_quadrant_maxima_map, ivec3(cell, quadrant));
#else
  vec4 texel = texelFetch(relievo_quadrant_maxima_map, ivec3(cell, quadrant), 0);
#endif
  precise vec4 both = texel * (65535.0 / 256.0);
  vec4 windows = floor(both);
  precise vec4 corners = both - windows;
  return QuadrantMaxima(windows, corners);
}

// Their widths in cells.
vec4 relievo_quadrant_maxima_widths() {
  const float first = float(quadrant_maxima_first), ratio = float(quadrant_maxima_ratio);
  return first * vec4(1.0, ratio, ratio * ratio, ratio * ratio * ratio);
}
