// The least (x) and greatest (y) height over the node of a level: cells [node << level, (node + 1) << level).
#include "shaders/lib/ray.glsl"

// The coarsest level, which is one node. Not textureQueryLevels: GLSL 330 and ESSL have none.
int relievo_min_max_pyramid_top() {
  ivec2 extent = textureSize(relievo_min_max_pyramid_map, 0);
  int longest = max(extent.x, extent.y);
  int top = 0;
  while (top < 15 && (1 << top) < longest) ++top;
  return top;
}

vec2 relievo_min_max_pyramid_at(ivec2 node, int level) {
  RELIEVO_COUNT_FETCHES(1);
  return texelFetch(relievo_min_max_pyramid_map, node, level).rg;
}
