// Radius over height of the cone on the nearest texel: longer sides of the map per unit of H, in [0, 1].
// Never interpolated: what is true of two cones is true of none in between.
#include "shaders/lib/fold.glsl"

float relievo_cone_ratio(vec2 uv) {
  RELIEVO_COUNT_FETCHES(1);
  vec2 extent = vec2(textureSize(relievo_cone_map, 0));
  ivec2 texel = relievo_fold_texel(floor(clamp(uv * extent, vec2(-1.0e9), vec2(1.0e9))), extent);
  float encoded = texelFetch(relievo_cone_map, texel, 0).r;
  return encoded * encoded;
}
