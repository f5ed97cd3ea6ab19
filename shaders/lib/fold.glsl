// Cells of the endless surface brought back to those of the map. Cell (i, j) lies between the texels i, i+1 and j, j+1.
// What a map says of a cell and of what lies ahead of it holds for the folded cell and the folded heading too:
//
// repeat: cell i + kW is cell i.
// mirror: every other tile runs backwards, so headings turn there; the flat cell −1 between two copies of texel 0 takes what
//         cell 0 has for the positive heading, which sees the same cells and one more.
// clamp, clip: beyond the edge nothing changes along the axis; the outermost cell sees all that the cells beyond it see.
#include "ray.glsl"

// x / extent, rounded down, for whole x of at most 1.1e6 in size: half a unit keeps the rounding of the product away from the
// whole numbers.
vec2 relievo_fold_periods(vec2 x, vec2 period) {
  precise vec2 periods = floor((x + 0.5) * (1.0 / period));
  return periods;
}

// The same cell or texel in the first period, which is two maps long where every other one runs backwards.
vec2 relievo_fold_to_first_period(vec2 cell, vec2 extent) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  precise vec2 first = cell - extent * relievo_fold_periods(cell, extent);
#elif RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  precise vec2 first = cell - 2.0 * extent * relievo_fold_periods(cell, 2.0 * extent);
#else
  vec2 first = cell;
#endif
  return first;
}

struct FoldedCell {
  vec2 cell;     // whole numbers in [0, extent)
  vec2 heading;  // each +1 or −1
};

FoldedCell relievo_fold_cell(vec2 cell, vec2 extent, vec2 heading) {
  vec2 phase = relievo_fold_to_first_period(cell, extent);
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  return FoldedCell(phase, heading);
#elif RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  bvec2 backwards = greaterThanEqual(phase, extent);
  bvec2 flat_cell = equal(phase, 2.0 * extent - 1.0);
  vec2 turned = mix(heading, -heading, vec2(backwards));
  return FoldedCell(max(mix(phase, 2.0 * extent - 2.0 - phase, vec2(backwards)), vec2(0.0)),
                    mix(turned, vec2(1.0), vec2(flat_cell)));
#else
  return FoldedCell(clamp(phase, vec2(0.0), extent - 1.0), heading);
#endif
}

int relievo_quadrant(vec2 heading) { return (heading.x < 0.0 ? 1 : 0) + (heading.y < 0.0 ? 2 : 0); }

ivec2 relievo_heading(int quadrant) { return ivec2((quadrant & 1) != 0 ? -1 : 1, (quadrant & 2) != 0 ? -1 : 1); }

// The same for texels. Whole numbers in floats, since integer division is slow where it is emulated: exact up to
// 1.1e6 texels, and within the map for all.
ivec2 relievo_fold_texel(vec2 texel, vec2 extent) {
  vec2 phase = relievo_fold_to_first_period(texel, extent);
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  phase = min(phase, 2.0 * extent - 1.0 - phase);
#endif
  return ivec2(clamp(phase, vec2(0.0), extent - 1.0));
}
