// Dummer 2006: the cone on texel i is as wide as the texels above it allow, min over j of |x_j - x_i| / (h_j - h_i).
// Heights and distances are compared squared, in texels; the ratio that is stored is in longer sides of the map per unit of H,
// at most 1, and as its square root, which keeps steep cones apart in 8 bits.
#include "shaders/lib/pyramid_walk.glsl"

// Whether something that rises by `rise` at this squared distance narrows the cone.
bool cone_narrows(float squared, float rise, float narrowest) {
  precise float reach = narrowest * rise * rise;
  return rise > 0.0 && squared < reach;
}

void cone_meet_texel(ivec2 texel, ivec2 other, ivec2 extent, float own, inout float narrowest) {
  float rise = texelFetch(relievo_height_map, other, 0).r - own;  // within the map: no need to wrap
  float squared = relievo_walk_squared(relievo_walk_gap(texel, other, other, extent));
  precise float ratio = squared / (rise * rise);
  if (cone_narrows(squared, rise, narrowest)) narrowest = ratio;
}

float cone_exhaustive_search(ivec2 texel, ivec2 extent, float own, float narrowest) {
  for (int y = 0; y < extent.y; ++y) {
    for (int x = 0; x < extent.x; ++x) cone_meet_texel(texel, ivec2(x, y), extent, own, narrowest);
  }
  return narrowest;
}

// The same texel decides as in the exhaustive search: a node is passed over only where none of its texels narrows the cone.
// A node's maximum is reached somewhere in it, so the node alone tells how wide the cone can be at most: `limit`, which
// passes over twice as much as what has been found does. It is rounded up, to keep the texel that decides.
float cone_pruned(ivec2 texel, ivec2 extent, float own, float widest) {
  float narrowest = widest, limit = widest;
  PyramidWalk walk = relievo_pyramid_walk(texel);
  while (walk.level < walk.top) {
    ivec2 first, last;
    bool matters = relievo_walk_texels(walk, extent, first, last);
    if (matters) {
      float squared = relievo_walk_squared(relievo_walk_gap(texel, first, last, extent));
      float rise = relievo_max_pyramid_at(relievo_walk_node(walk), walk.level) - own;
      matters = cone_narrows(squared, rise, limit);
      float span = relievo_walk_squared(relievo_walk_span(texel, first, last));
      if (cone_narrows(span, rise, limit)) limit = span / (rise * rise) * 1.000001;
    }
    if (matters && walk.level > 0) {
      relievo_walk_descend(walk);
    } else {
      if (matters) cone_meet_texel(texel, first, extent, own, narrowest);
      relievo_walk_pass(walk);
    }
  }
  return narrowest;
}

void relievo_bake(ivec2 texel) {
  ivec2 extent = textureSize(relievo_height_map, 0);
  float longest = float(max(extent.x, extent.y));
  float own = texelFetch(relievo_height_map, texel, 0).r;
  float widest = longest * longest;
  float narrowest = cone_exhaustive == 1 ? cone_exhaustive_search(texel, extent, own, widest)
                                         : cone_pruned(texel, extent, own, widest);
  // Four roundings up to here, each under 2^-23; a cone may only be too narrow.
  precise float ratio = sqrt(narrowest) / longest * 0.9999995;
  precise float encoded = sqrt(ratio) * 0.9999995;
  relievo_bake_write(texel, 0, encoded);
}
