// Cell (i, j) lies between the texels i, i+1 and j, j+1. With mirror, clamp and clip the cell before texel 0 is not here: it is
// flat, and readers make it of what cell 0 has.
#include "shaders/lib/bake.glsl"

void relievo_bake(ivec2 texel) {
  ivec2 extent = relievo_bake_extent();
  relievo_bake_write(texel, 0, relievo_height_texel(texel, extent));
  relievo_bake_write(texel, 1, relievo_height_texel(texel + ivec2(1, 0), extent));
  relievo_bake_write(texel, 2, relievo_height_texel(texel + ivec2(0, 1), extent));
  relievo_bake_write(texel, 3, relievo_height_texel(texel + ivec2(1, 1), extent));
}
