// Windows that grow ahead of every cell. Let a ray of a sector with the slopes lo to hi head along its greater axis: it
// starts anywhere in cell (0, 0) and enters, i columns ahead, the rows floor(lo max(i - 1, 0)) to ceil(1 + hi (i + 1)) - 1. V(n)
// covers these for i < n. V(n) at the cell, and at the cells d columns ahead and lo d or hi d rows up (rounded down and up),
// cover V(n + d) for d <= n / 4, and all small n: floor(x) + floor(y) <= floor(x + y), the same for ceil upwards, and a column
// has at least two rows, so that none is left out between the two. A quadrant's windows are squares and take a fourth.
//
// Cells outside V(n) are at a distance of at least n - 1. Where V(n + d) is above V(n), (V(n + d) - A) / (n - 1) bounds the
// slope of what is highest there; the rest of V(n + d) is no higher than it and no nearer than what it had to be above.
//
// Cells at the border of a map that does not repeat stand for those beyond, into which the sector is seen from elsewhere: they
// take the steepest slope of their quadrant (README).
//
// Channels 0 and 1 hold the windows of this pass and of the one before, in turn, and 2 the slope; the last two passes
// replace them by what the map holds.
#include "shaders/lib/bake.glsl"
#include "shaders/lib/cone_slope.glsl"
#include "shaders/lib/cone_windows.glsl"
#include "shaders/lib/sector.glsl"

// Phases of the passes; map.toml has how many passes each takes.
const int DIRECTIONAL_CONE_BEGIN = 0, DIRECTIONAL_CONE_GROW = 1, DIRECTIONAL_CONE_BORDER = 2;

struct Sector {
  ivec2 heading;
  int slice;
  ivec2 along, across;  // of the greater axis and of the other
  int cuts, cut;        // the slopes are cut / cuts to (cut + 1) / cuts; cuts = 0: the whole quadrant
};

Sector directional_cone_sector() {
  int layer = relievo_bake_layer();
  Sector sector;
  sector.heading = relievo_sector_heading(layer);
  sector.slice = relievo_sector_slice_of(layer, directional_cone_sectors);
  sector.cuts = directional_cone_sectors / 8;
  bool steep = sector.cuts > 0 && sector.slice >= sector.cuts;
  sector.cut = steep ? sector.slice - sector.cuts : sector.slice;
  sector.along = steep ? ivec2(0, sector.heading.y) : ivec2(sector.heading.x, 0);
  sector.across = sector.heading - sector.along;
  return sector;
}

float directional_cone_highest(ivec2 cell) {
  FoldedCell folded = relievo_fold_cell(vec2(cell), vec2(relievo_bake_extent()), vec2(1.0));
  return texelFetch(relievo_max_pyramid_map, ivec2(folded.cell), 0).r;
}

// A: over the cell and those that touch it ahead.
float directional_cone_apex(ivec2 cell, ivec2 heading) {
  return max(max(directional_cone_highest(cell), directional_cone_highest(cell + heading)),
             max(directional_cone_highest(cell + ivec2(heading.x, 0)), directional_cone_highest(cell + ivec2(0, heading.y))));
}

float directional_cone_folded(ivec2 cell, Sector sector, int channel) {
  ivec2 extent = relievo_bake_extent();
  if (all(equal(clamp(cell, ivec2(0), extent - 1), cell))) return relievo_bake_read(cell, relievo_bake_layer(), channel);
  FoldedCell folded = relievo_fold_cell(vec2(cell), vec2(extent), vec2(sector.heading));
  return relievo_bake_read(ivec2(folded.cell), relievo_sector_layer(folded.heading, sector.slice), channel);
}

// With mirror, the flat cells between two copies of texel 0 are not in the map. The windows of their neighbours cover theirs.
bool directional_cone_is_absent(ivec2 cell) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  vec2 phase = relievo_fold_to_first_period(vec2(cell + 1), vec2(relievo_bake_extent()));
  return phase.x == 0.0 || phase.y == 0.0;
#else
  return false;
#endif
}

float directional_cone_window(ivec2 cell, Sector sector, int channel) {
  if (!directional_cone_is_absent(cell)) return directional_cone_folded(cell, sector, channel);
  float greatest = 0.0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i)
      greatest = max(greatest, directional_cone_folded(cell + ivec2(i, j), sector, channel));
  }
  return greatest;
}

// V(2): the cells that touch, and row 2 of column 1, at the distance 1, if the sector goes there.
void directional_cone_begin(ivec2 cell, Sector sector) {
  float apex = directional_cone_apex(cell, sector.heading);
  bool has_third_row = 2 * (sector.cut + 1) > sector.cuts && sector.cuts > 0;
  float third = has_third_row ? directional_cone_highest(cell + sector.along + 2 * sector.across) : 0.0;
  relievo_bake_write(cell, 0, max(apex, third));
  relievo_bake_write(cell, 1, 0.0);
  relievo_bake_write(cell, 2, max(third - apex, 0.0));
}

void directional_cone_grow(ivec2 cell, Sector sector, int columns, int growth, int from, int to) {
  int low = sector.cuts > 0 ? sector.cut * growth / sector.cuts : 0;
  int high = sector.cuts > 0 ? ((sector.cut + 1) * growth + sector.cuts - 1) / sector.cuts : growth;
  float before = relievo_bake_read(cell, relievo_bake_layer(), from);
  ivec2 ahead = cell + growth * sector.along;
  float after = max(before, max(directional_cone_window(ahead + low * sector.across, sector, from),
                                directional_cone_window(ahead + high * sector.across, sector, from)));
  if (sector.cuts == 0) after = max(after, directional_cone_window(cell + growth * sector.across, sector, from));
  relievo_bake_write(cell, to, after);
  // Asked together: of a condition on the pass alone, drivers would compile the program again for every pass.
  if (after <= before || columns - 1 > directional_cone_reach) return;
  precise float slope = (after - directional_cone_apex(cell, sector.heading)) / float(columns - 1);
  relievo_bake_write(cell, 2, max(relievo_bake_read(cell, relievo_bake_layer(), 2), slope));
}

bool directional_cone_is_at_border(ivec2 cell) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  return false;
#else
  return any(equal(cell, ivec2(0))) || any(equal(cell, relievo_bake_extent() - 1));
#endif
}

float directional_cone_slope(ivec2 cell, Sector sector) {
  float slope = relievo_bake_read(cell, relievo_bake_layer(), 2);
  if (!directional_cone_is_at_border(cell)) return slope;
  for (int slice = 0; slice < relievo_sector_slices(directional_cone_sectors); ++slice)
    slope = max(slope, relievo_bake_read(cell, relievo_sector_layer(vec2(sector.heading), slice), 2));
  return slope;
}

void relievo_bake(ivec2 cell) {
  Sector sector = directional_cone_sector();
  if (RELIEVO_BAKE_PHASE == DIRECTIONAL_CONE_BEGIN) {
    directional_cone_begin(cell, sector);
  } else if (RELIEVO_BAKE_PHASE == DIRECTIONAL_CONE_GROW) {
    int pass = relievo_bake_pass();
    directional_cone_grow(cell, sector, relievo_cone_window(pass), relievo_cone_growth(pass), (pass - 1) % 2, pass % 2);
  } else if (RELIEVO_BAKE_PHASE == DIRECTIONAL_CONE_BORDER) {
    relievo_bake_write(cell, 0, relievo_cone_encode(directional_cone_slope(cell, sector)));
  } else {
    relievo_bake_write(cell, 2, relievo_bake_read(cell, relievo_bake_layer(), 0));
    relievo_bake_write(cell, 0, directional_cone_highest(cell));
    relievo_bake_write(cell, 1, directional_cone_apex(cell, sector.heading));
  }
}
