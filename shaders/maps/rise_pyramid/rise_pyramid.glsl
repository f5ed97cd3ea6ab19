// The least rises (H) to the next texel along +u, -u, +v, -v from any of the node's 2^level texels squared, for levels from 2 on.
#include "shaders/lib/ray.glsl"

const int RELIEVO_RISE_PYRAMID_FINEST = 2;

vec4 relievo_rise_pyramid_at(ivec2 node, int level) {
  RELIEVO_COUNT_FETCHES(1);
  return texelFetch(relievo_rise_pyramid_map, node, level - RELIEVO_RISE_PYRAMID_FINEST);
}
