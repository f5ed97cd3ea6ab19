// Donnelly 2005, with a pruned search in place of Danielsson's algorithm.
//
// Distances are Euclidean where the lid is `scale` longer sides of the map above the base, and in units of that height: they
// lie in [0, 1], since the base is H away at most. Each cell counts as a box up to its highest corner; the surface in it is
// nowhere higher, so no distance is too long. What is near one layer is near the next: one search serves four.
#include "shaders/lib/pyramid_walk.glsl"
#if RELIEVO_BAKE_LAYERS_AT_ONCE != 4
#error "distance_field searches for four layers at once"
#endif

// Squared distances to a column that is so far below, `squared` texels² aside.
vec4 distance_field_to(float squared, float aside, vec4 drop) {
  precise vec4 below = max(drop, 0.0);
  precise vec4 sum = squared * aside + below * below;
  return sum;
}

void relievo_bake(ivec2 texel) {
  ivec2 extent = textureSize(relievo_height_map, 0);
  int layer = relievo_bake_layer();
  // A quotient, 2.5 ulp, and the product, 1, may be 3.5 * 2^-23 too high; from a lower place distances are only shorter.
  precise vec4 height = (float(layer) + vec4(0.5, 1.5, 2.5, 3.5)) / float(distance_field_layers) * 0.9999995;
  precise float texel_size = 1.0 / (float(max(extent.x, extent.y)) * distance_field_scale);
  precise float aside = texel_size * texel_size;
  vec4 shortest = distance_field_to(0.0, aside, height - relievo_max_pyramid_at(texel, 0));
  vec4 limit = shortest;
  for (int k = 1; k < 4; ++k) limit[k] = relievo_bake_has_layer(layer + k) ? limit[k] : 0.0;
  PyramidWalk walk = relievo_pyramid_walk(texel);
  while (walk.level < walk.top && any(greaterThan(limit, vec4(0.0)))) {
    ivec2 first, last;
    bool matters = relievo_walk_texels(walk, extent, first, last);
    if (matters) {
      vec4 drop = height - relievo_max_pyramid_at(relievo_walk_node(walk), walk.level);
      float nearest = relievo_walk_squared(relievo_walk_gap(texel, first, last + 1, extent));
      vec4 least = distance_field_to(nearest, aside, drop);
      matters = any(lessThan(least, limit));
      if (matters && walk.level == 0) shortest = min(shortest, least);
      vec4 span = distance_field_to(relievo_walk_squared(relievo_walk_span(texel, first, last)), aside, drop);
      limit = min(limit, walk.level == 0 ? least : span * 1.000001);
    }
    if (matters && walk.level > 0) {
      relievo_walk_descend(walk);
    } else {
      relievo_walk_pass(walk);
    }
  }
  // A distance may only be too short. In ulp, 2^-23: 5 of what the square is made of (half of its 10), 6.5 of the root, 1 of this.
  precise vec4 distance = sqrt(mix(shortest, vec4(0.0), equal(limit, vec4(0.0)))) * 0.9999985;
  for (int k = 0; k < 4; ++k) relievo_bake_write_layer(texel, layer + k, 0, distance[k]);
}
