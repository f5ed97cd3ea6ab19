// Pass 0: the greatest of the four corners of a cell, which bounds it, in channel 0. Passes 1 to 4: a window is so many by so many
// of the windows of the pass before; they go to the channels 1, 2, 3, 0. Reads beyond the map are folded back into it, with the
// quadrant's direction where it runs backwards. The last pass packs the four windows and the four corners.
#include "shaders/lib/bake.glsl"
#include "shaders/lib/bake_corners.glsl"
#include "shaders/lib/fold.glsl"

const int QUADRANT_MAXIMA_PACK = 5;  // the last pass

float quadrant_maxima_below(ivec2 cell, ivec2 heading, int channel) {
  FoldedCell folded = relievo_fold_cell(vec2(cell), vec2(relievo_bake_extent()), vec2(heading));
  return relievo_bake_read(ivec2(folded.cell), relievo_quadrant(folded.heading), channel);
}

float quadrant_maxima_window(ivec2 texel, int pass) {
  ivec2 heading = relievo_heading(relievo_bake_layer());
  int count = pass == 1 ? quadrant_maxima_first : quadrant_maxima_ratio;
  int stride = pass == 1 ? 1 : quadrant_maxima_first;
  for (int k = 2; k < pass; ++k) stride *= quadrant_maxima_ratio;
  float greatest = 0.0;
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      greatest = max(greatest, quadrant_maxima_below(texel + stride * ivec2(i, j) * heading, heading, pass - 1));
    }
  }
  return greatest;
}

// Heights in 255ths, rounded up. What is a 255th but for its rounding to a float stays that 255th, so that a
// value can be 2^-22 of H too low.
vec4 quadrant_maxima_bytes(vec4 heights) { return clamp(ceil(heights * 255.0 - 255.0 / 8388608.0), 0.0, 255.0); }

void quadrant_maxima_pack(ivec2 texel) {
  int quadrant = relievo_bake_layer();
  vec4 windows;
  for (int k = 0; k < 4; ++k) windows[k] = relievo_bake_read(texel, quadrant, (k + 1) & 3);
  vec4 corners = relievo_bake_corners(texel);
  ivec2 heading = relievo_heading(quadrant);
  if (heading.x < 0) corners = corners.yxwz;
  if (heading.y < 0) corners = corners.zwxy;
  vec4 packed = 256.0 * quadrant_maxima_bytes(windows) + quadrant_maxima_bytes(corners);
  for (int k = 0; k < 4; ++k) relievo_bake_write(texel, k, min(packed[k] / 65535.0, 1.0));  // a quotient may be above 1
}

void relievo_bake(ivec2 texel) {
  const int pass = RELIEVO_BAKE_PHASE;  // each is a program of its own
  if (pass == QUADRANT_MAXIMA_PACK) {
    quadrant_maxima_pack(texel);
  } else {
    float greatest = pass == 0 ? relievo_bake_highest_corner(texel) : quadrant_maxima_window(texel, pass);
    relievo_bake_write(texel, pass & 3, greatest);
  }
}
