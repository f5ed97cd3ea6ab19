// Level 0: the least of 4 × 4 texels. Level k: the least of four nodes. Padding to a power of two rises by 1, which changes no
// least.
#include "shaders/lib/bake.glsl"
#include "shaders/lib/outward.glsl"

vec4 rise_pyramid_texel(ivec2 texel) {
  ivec2 extent = textureSize(relievo_height_map, 0);
  if (any(greaterThanEqual(texel, extent))) return vec4(1.0);
  float own = texelFetch(relievo_height_map, texel, 0).r;
  float right = relievo_outward_height(texel + ivec2(1, 0), extent), left = relievo_outward_height(texel - ivec2(1, 0), extent);
  float down = relievo_outward_height(texel + ivec2(0, 1), extent), up = relievo_outward_height(texel - ivec2(0, 1), extent);
  return vec4(right, left, down, up) - own;
}

vec4 rise_pyramid_child(ivec2 child) {
  if (relievo_bake_level() == 0) return rise_pyramid_texel(child);
  vec4 rises;
  for (int k = 0; k < 4; ++k) rises[k] = relievo_bake_read_below(child, k);
  return rises;
}

void relievo_bake(ivec2 texel) {
  int children = relievo_bake_level() == 0 ? 4 : 2;
  vec4 rises = vec4(1.0);
  for (int j = 0; j < children; ++j) {
    for (int i = 0; i < children; ++i) rises = min(rises, rise_pyramid_child(children * texel + ivec2(i, j)));
  }
  for (int k = 0; k < 4; ++k) relievo_bake_write(texel, k, rises[k]);
}
