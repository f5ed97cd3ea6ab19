// Cell (i, j) lies between the texels i, i+1 and j, j+1. With mirror, clamp and clip the cell before texel 0 is not here: it is
// flat, and readers make it of what cell 0 has.
#include "shaders/lib/bake.glsl"
#include "shaders/lib/bake_corners.glsl"

void relievo_bake(ivec2 texel) {
  vec4 corners = relievo_bake_corners(texel);
  relievo_bake_write(texel, 0, corners.x);
  relievo_bake_write(texel, 1, corners.y);
  relievo_bake_write(texel, 2, corners.z);
  relievo_bake_write(texel, 3, corners.w);
}
