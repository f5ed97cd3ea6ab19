// Radius over height of the relaxed cone on the nearest texel: longer sides of the map per unit of H, in [0, 1].
// Never interpolated: what is true of two cones is true of none in between.
#include "shaders/lib/ray.glsl"

float relievo_relaxed_cone_ratio(vec2 uv) {
  RELIEVO_COUNT_FETCHES(1);
  ivec2 extent = textureSize(relievo_relaxed_cone_map, 0);
  ivec2 texel = ivec2(floor(clamp(uv * vec2(extent), vec2(-1.0e9), vec2(1.0e9))));
  ivec2 wrapped = ivec2(relievo_wrap_texel(texel.x, extent.x), relievo_wrap_texel(texel.y, extent.y));
  float encoded = texelFetch(relievo_relaxed_cone_map, wrapped, 0).r;
  return encoded * encoded;
}
