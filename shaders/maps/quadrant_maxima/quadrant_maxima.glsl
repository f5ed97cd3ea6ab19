// What lies ahead of a cell, for rays that head for one quadrant.
#include "shaders/lib/fold.glsl"

struct QuadrantMaxima {
  vec4 windows;  // greatest heights over the windows, smallest first; 1 + H · 255/256
  vec4 corners;  // of the cell: near, across in u, across in v, far
};

// Heights are compared as 1 + H · 255/256: a byte of them becomes such a float, in [1, 2), by two operations on its bits.
const float RELIEVO_QUADRANT_MAXIMA_UNIT = 255.0 / 256.0;

// A channel holds a window's byte above a corner's.
QuadrantMaxima relievo_quadrant_maxima_at(ivec2 cell, int quadrant) {
  RELIEVO_COUNT_FETCHES(1);
#if quadrant_maxima_fetch == quadrant_maxima_fetch_image
  uvec4 texel = imageLoad(relievo_quadrant_maxima_map, ivec3(cell, quadrant));
#else
  uvec4 texel = texelFetch(relievo_quadrant_maxima_map, ivec3(cell, quadrant), 0);
#endif
  vec4 windows = uintBitsToFloat(((texel & 0xff00u) << 7) | 0x3f800000u);
  vec4 corners = uintBitsToFloat(((texel & 0x00ffu) << 15) | 0x3f800000u);
  return QuadrantMaxima(windows, corners);
}

// Their widths in cells.
vec4 relievo_quadrant_maxima_widths() {
  const float first = float(quadrant_maxima_first), ratio = float(quadrant_maxima_ratio);
  return first * vec4(1.0, ratio, ratio * ratio, ratio * ratio * ratio);
}
