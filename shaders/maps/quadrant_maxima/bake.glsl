// Pass 0: the greatest of the four corners of a cell, which bounds it. Later passes: a window is n × n of the
// windows of the pass before. Reads beyond the map are folded back into it, with the quadrant's direction where it runs backwards.
#include "shaders/lib/bake.glsl"
#include "shaders/lib/bake_corners.glsl"
#include "shaders/lib/fold.glsl"

float quadrant_maxima_below(ivec2 cell, ivec2 heading, int channel) {
  ivec2 extent = relievo_bake_extent();
  FoldedCell folded = relievo_fold_cell(vec2(cell), vec2(extent), vec2(heading));
  return relievo_bake_read(ivec2(folded.cell), relievo_quadrant(folded.heading), channel);
}

void relievo_bake(ivec2 texel) {
  int pass = relievo_bake_pass();
  if (pass == 0) {
    relievo_bake_write(texel, 0, relievo_bake_highest_corner(texel));
    return;
  }
  ivec2 heading = relievo_heading(relievo_bake_layer());
  int count = pass == 1 ? quadrant_maxima_first : quadrant_maxima_ratio;
  int stride = pass == 1 ? 1 : pass == 2 ? quadrant_maxima_first : quadrant_maxima_first * quadrant_maxima_ratio;
  float greatest = 0.0;
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      ivec2 offset = stride * ivec2(i, j) * heading;
      greatest = max(greatest, quadrant_maxima_below(texel + offset, heading, pass - 1));
    }
  }
  relievo_bake_write(texel, pass, greatest);
}
