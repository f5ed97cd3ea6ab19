// Of cell (i, j): the extremes of all texels that the cells i - r … i + r, j - r … j + r have for corners. A bilinear patch is
// nowhere beyond its corners. With mirror, clamp and clip, cell -1 reads cell 0, whose texels bound it as far as r - 1 cells
// before it. Reads (2r + 2)² texels.
#include "shaders/lib/bake.glsl"

void relievo_bake(ivec2 texel) {
  ivec2 extent = textureSize(relievo_height_map, 0);
  float low = 1.0, high = 0.0;
  for (int j = -dilation_erosion_radius; j <= dilation_erosion_radius + 1; ++j) {
    for (int i = -dilation_erosion_radius; i <= dilation_erosion_radius + 1; ++i) {
      float height = relievo_height_texel(texel + ivec2(i, j), extent);
      low = min(low, height);
      high = max(high, height);
    }
  }
  relievo_bake_write(texel, 0, low);
  relievo_bake_write(texel, 1, high);
}
