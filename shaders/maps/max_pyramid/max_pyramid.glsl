// The greatest height over the node of a level: cells [node << level, (node + 1) << level).
#include "shaders/lib/ray.glsl"

int relievo_max_pyramid_levels() { return textureQueryLevels(relievo_max_pyramid_map); }

float relievo_max_pyramid_at(ivec2 node, int level) {
  RELIEVO_COUNT_FETCHES(1);
  return texelFetch(relievo_max_pyramid_map, node, level).r;
}
