// Donnelly 2005, with a pruned search in place of Danielsson's algorithm.
//
// Distances are Euclidean where the lid is `scale` longer sides of the map above the base, and in units of that height: they
// lie in [0, 1], since the base is H away at most. Each cell counts as a box up to its highest corner; the surface in it is
// nowhere higher, so no distance is too long.
#include "shaders/lib/pyramid_walk.glsl"

// Squared distance to a column of this height, `squared` texels² aside.
float distance_field_to(float squared, float aside, float drop) {
  precise float below = max(drop, 0.0);
  precise float sum = squared * aside + below * below;
  return sum;
}

void relievo_bake(ivec2 texel) {
  ivec2 extent = textureSize(relievo_height_map, 0);
  float height = (float(relievo_bake_layer()) + 0.5) / float(distance_field_layers);
  precise float texel_size = 1.0 / (float(max(extent.x, extent.y)) * distance_field_scale);
  precise float aside = texel_size * texel_size;
  float shortest = distance_field_to(0.0, aside, height - relievo_max_pyramid_at(texel, 0));
  float limit = shortest;
  PyramidWalk walk = relievo_pyramid_walk(texel);
  while (walk.level < walk.top && limit > 0.0) {
    ivec2 first, last;
    bool matters = relievo_walk_texels(walk, extent, first, last);
    if (matters) {
      float drop = height - relievo_max_pyramid_at(relievo_walk_node(walk), walk.level);
      float nearest = relievo_walk_squared(relievo_walk_gap(texel, first, last + 1, extent));
      float least = distance_field_to(nearest, aside, drop);
      matters = least < limit;
      if (matters && walk.level == 0) shortest = min(shortest, least);
      float span = distance_field_to(relievo_walk_squared(relievo_walk_span(texel, first, last)), aside, drop);
      limit = min(limit, walk.level == 0 ? least : span * 1.000001);
    }
    if (matters && walk.level > 0) {
      relievo_walk_descend(walk);
    } else {
      relievo_walk_pass(walk);
    }
  }
  if (limit == 0.0) shortest = 0.0;
  // A few roundings up to here, each under 2^-23; a distance may only be too short.
  precise float distance = sqrt(shortest) * 0.999999;
  relievo_bake_write(texel, 0, distance);
}
