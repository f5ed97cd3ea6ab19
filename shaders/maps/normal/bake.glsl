// Survey Eq. 9 with finite differences: the normal of (u, v, scale h) is normalize(-scale dh/du, -scale dh/dv, 1).
#include "shaders/lib/bake.glsl"

void relievo_bake(ivec2 texel) {
  ivec2 extent = textureSize(relievo_height_map, 0);
  float left = relievo_height_texel(texel - ivec2(1, 0), extent), right = relievo_height_texel(texel + ivec2(1, 0), extent);
  float up = relievo_height_texel(texel - ivec2(0, 1), extent), down = relievo_height_texel(texel + ivec2(0, 1), extent);
  precise vec2 gradient = 0.5 * vec2(right - left, down - up) * vec2(extent);
  precise vec2 slope = -normal_scale * gradient;
  precise float size = sqrt(slope.x * slope.x + slope.y * slope.y + 1.0);
  precise vec3 normal = vec3(slope, 1.0) / size;
  relievo_bake_write(texel, 0, normal.x);
  relievo_bake_write(texel, 1, normal.y);
  relievo_bake_write(texel, 2, normal.z);
}
