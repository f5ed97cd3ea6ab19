// Windows that grow around every cell: W(r), the greatest height over the cells at most r away along both axes. The four
// windows W(r) at the corners of a square make W(r + d), for d <= r. Where W(r') is above W(r), what is highest lies more than
// r away from the cell, which is at a distance of at least r: (W(r') - A) / r bounds its slope. Slopes come out at
// most as much too steep as windows grow in a pass.
//
// Channels 0 and 1 hold the windows of this pass and of the one before, in turn, and 2 the slope. The last pass replaces
// them by what the map holds.
#include "shaders/lib/bake.glsl"
#include "shaders/lib/cone_slope.glsl"
#include "shaders/lib/cone_windows.glsl"
#include "shaders/lib/fold.glsl"

// Phases of the passes; map.toml has how many passes each takes.
const int ROBUST_CONE_BEGIN = 0, ROBUST_CONE_GROW = 1;

float robust_cone_highest(ivec2 cell) {
  FoldedCell folded = relievo_fold_cell(vec2(cell), vec2(relievo_bake_extent()), vec2(1.0));
  return texelFetch(relievo_max_pyramid_map, ivec2(folded.cell), 0).r;
}

// A: over the cell and those that touch it.
float robust_cone_apex(ivec2 cell) {
  float apex = 0.0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) apex = max(apex, robust_cone_highest(cell + ivec2(i, j)));
  }
  return apex;
}

float robust_cone_window(ivec2 cell, int channel) {
  ivec2 extent = relievo_bake_extent();
  if (all(equal(clamp(cell, ivec2(0), extent - 1), cell))) return relievo_bake_read(cell, 0, channel);
  FoldedCell folded = relievo_fold_cell(vec2(cell), vec2(extent), vec2(1.0));
  return relievo_bake_read(ivec2(folded.cell), 0, channel);
}

void robust_cone_grow(ivec2 cell, int radius, int growth, int from, int to) {
  float before = robust_cone_window(cell, from);
  float after = max(max(robust_cone_window(cell + ivec2(-growth, -growth), from),
                        robust_cone_window(cell + ivec2(growth, -growth), from)),
                    max(robust_cone_window(cell + ivec2(-growth, growth), from),
                        robust_cone_window(cell + ivec2(growth, growth), from)));
  relievo_bake_write(cell, to, after);
  // Asked together: of a condition on the pass alone, drivers would compile the program again for every pass.
  if (after <= before || radius > robust_cone_reach) return;
  precise float slope = (after - robust_cone_apex(cell)) / float(radius);
  relievo_bake_write(cell, 2, max(relievo_bake_read(cell, 0, 2), slope));
}

void relievo_bake(ivec2 cell) {
  if (RELIEVO_BAKE_PHASE == ROBUST_CONE_BEGIN) {
    relievo_bake_write(cell, 0, robust_cone_apex(cell));
    for (int channel = 1; channel < 3; ++channel) relievo_bake_write(cell, channel, 0.0);
  } else if (RELIEVO_BAKE_PHASE == ROBUST_CONE_GROW) {
    int pass = relievo_bake_pass();
    robust_cone_grow(cell, relievo_cone_window(pass) - 1, relievo_cone_growth(pass), (pass - 1) % 2, pass % 2);
  } else {
    relievo_bake_write(cell, 0, robust_cone_highest(cell));
    relievo_bake_write(cell, 1, robust_cone_apex(cell));
    relievo_bake_write(cell, 2, relievo_cone_encode(relievo_bake_read(cell, 0, 2)));
  }
}
