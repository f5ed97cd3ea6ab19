// The heights at the corners 00, 10, 01, 11 of a cell of the endless surface (fold.glsl): whole numbers, of any sign.
#include "shaders/lib/fold.glsl"

vec4 relievo_cell_corners_at(vec2 cell, vec2 extent) {
  RELIEVO_COUNT_FETCHES(1);
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  return texelFetch(relievo_cell_corners_map, ivec2(relievo_fold_cell(cell, extent, vec2(1.0)).cell), 0);
#else
  // Which columns and rows of a stored cell the low and the high side take: both the same where the cell is flat, swapped
  // where the map runs backwards.
  ivec2 low = relievo_fold_texel(cell, extent);
  ivec2 high = relievo_fold_texel(cell + 1.0, extent);
  ivec2 stored = min(low, high);
  vec4 corners = texelFetch(relievo_cell_corners_map, stored, 0);
  bvec2 low_is_stored = equal(low, stored), high_is_stored = equal(high, stored);
  vec4 columns = vec4(low_is_stored.x ? corners.xz : corners.yw, high_is_stored.x ? corners.xz : corners.yw);
  vec2 first = low_is_stored.y ? columns.xz : columns.yw;
  vec2 second = high_is_stored.y ? columns.xz : columns.yw;
  return vec4(first, second);
#endif
}
