// Level 0: cell (i, j) lies between the texels i, i+1 and j, j+1, and is bounded by its highest corner.
// With mirror, clamp and clip, cell 0 also covers the half texel before texel 0, which its corners bound as well.
// Level k: the maximum of four. Padding to a power of two is 0: it lies outside every tile.
#include "shaders/lib/bake.glsl"
#include "shaders/lib/bake_corners.glsl"

float max_pyramid_cell(ivec2 cell) {
  bool is_padding = any(greaterThanEqual(cell, textureSize(relievo_height_map, 0)));
  return is_padding ? 0.0 : relievo_bake_highest_corner(cell);
}

void relievo_bake(ivec2 texel) {
  float value;
  if (relievo_bake_level() == 0) {
    value = max_pyramid_cell(texel);
  } else {
    ivec2 child = 2 * texel;
    value = max(max(relievo_bake_read_below(child, 0), relievo_bake_read_below(child + ivec2(1, 0), 0)),
                max(relievo_bake_read_below(child + ivec2(0, 1), 0), relievo_bake_read_below(child + ivec2(1, 1), 0)));
  }
  relievo_bake_write(texel, 0, value);
}
