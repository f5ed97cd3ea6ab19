// The larger of the height differences across a texel along u and v.
#include "shaders/lib/bake.glsl"

void relievo_bake(ivec2 texel) {
  ivec2 extent = relievo_bake_extent();
  float along_u = relievo_height_texel(texel + ivec2(1, 0), extent) - relievo_height_texel(texel - ivec2(1, 0), extent);
  float along_v = relievo_height_texel(texel + ivec2(0, 1), extent) - relievo_height_texel(texel - ivec2(0, 1), extent);
  relievo_bake_write(texel, 0, max(abs(along_u), abs(along_v)));
}
