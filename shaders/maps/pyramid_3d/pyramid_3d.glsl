// The greatest height over the node of a level: cells [node << level, (node + 1) << level). Reads one level of detail only.
#include "packing.glsl"
#include "shaders/lib/ray.glsl"

ivec2 relievo_pyramid_3d_extent() { return textureSize(relievo_pyramid_3d_map, 0).xy; }

int relievo_pyramid_3d_top() { return relievo_packed_top(relievo_pyramid_3d_extent()); }

float relievo_pyramid_3d_at(ivec2 node, int level) {
  RELIEVO_COUNT_FETCHES(1);
  if (level == 0) return texelFetch(relievo_pyramid_3d_map, ivec3(node, 0), 0).r;
  ivec2 texel = relievo_packed_origin(relievo_pyramid_3d_extent(), level) + node;
  return texelFetch(relievo_pyramid_3d_map, ivec3(texel, 1), 0).r;
}
