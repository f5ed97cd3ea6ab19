// Dummer 2006: the cone on texel i is as wide as the texels above it allow.
#include "shaders/lib/cone_bake.glsl"

void cone_meet_texel(ivec2 texel, ivec2 other, ivec2 extent, float own, inout float narrowest) {
  float rise = texelFetch(relievo_height_map, other, 0).r - own;  // within the map: no need to wrap
  narrowest = relievo_cone_to(relievo_walk_squared(relievo_walk_gap(texel, other, other, extent)), rise, narrowest);
}

float cone_exhaustive_search(ivec2 texel, ivec2 extent, float own, float narrowest) {
  for (int y = 0; y < extent.y; ++y) {
    for (int x = 0; x < extent.x; ++x) cone_meet_texel(texel, ivec2(x, y), extent, own, narrowest);
  }
  return narrowest;
}

// The same texel decides as in the exhaustive search: a node is passed over only where none of its texels narrows the cone.
// A node's maximum is reached somewhere in it, so the node alone tells how wide the cone can be at most: `limit`, which
// passes over twice as much as what has been found does.
float cone_pruned(ivec2 texel, ivec2 extent, float own, float widest) {
  float narrowest = widest, limit = widest;
  PyramidWalk walk = relievo_pyramid_walk(texel);
  while (walk.level < walk.top) {
    ivec2 first, last;
    bool matters = relievo_walk_texels(walk, extent, first, last);
    if (matters) {
      float squared = relievo_walk_squared(relievo_walk_gap(texel, first, last, extent));
      float rise = relievo_max_pyramid_at(relievo_walk_node(walk), walk.level) - own;
      matters = relievo_cone_may_narrow(squared, rise, limit);
      limit = relievo_cone_to(relievo_walk_squared(relievo_walk_span(texel, first, last)), rise, limit);
    }
    if (matters && walk.level > 0) {
      relievo_walk_descend(walk);
    } else {
      if (matters) cone_meet_texel(texel, first, extent, own, narrowest);
      limit = min(limit, narrowest);
      relievo_walk_pass(walk);
    }
  }
  return narrowest;
}

void relievo_bake(ivec2 texel) {
  ivec2 extent = textureSize(relievo_height_map, 0);
  float own = texelFetch(relievo_height_map, texel, 0).r, widest = relievo_cone_widest(extent);
  float narrowest = cone_exhaustive == 1 ? cone_exhaustive_search(texel, extent, own, widest)
                                         : cone_pruned(texel, extent, own, widest);
  relievo_bake_write(texel, 0, relievo_cone_stored(narrowest, extent));
}
