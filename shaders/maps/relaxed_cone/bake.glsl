// Policarpo and Oliveira 2007, without marching rays: a ray that falls away from the axis of the cone leaves the surface where the
// surface falls faster. The cone on texel i is as wide as the texels j that fall away from it allow. Slopes that rise away from
// texel i do not count: a ray enters there.
#include "shaders/lib/cone_bake.glsl"
#include "shaders/lib/outward.glsl"

// From one texel to the nearest image of another.
ivec2 relaxed_cone_way(ivec2 texel, ivec2 other, ivec2 extent) {
  ivec2 way = other - texel;
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  way -= extent * ivec2(greaterThan(2 * way, extent));
  way += extent * ivec2(lessThan(2 * way, -extent));
#endif
  return way;
}

// The least rise along one axis, over the way there, of the surface behind a texel that lies `way` texels off. The texel stands
// for the half texel around it, so the way is half a texel longer or shorter, and where it is none leads to either side.
float relaxed_cone_least_rise(int way, float forth, float back) {
  float rise = way == 0 ? min(forth, back) : way > 0 ? forth : back;
  return rise * (rise < 0.0 ? float(abs(way)) + 0.5 : max(float(abs(way)) - 0.5, 0.0));
}

// Whether a ray that passes above texel i on its way to j leaves the surface at j: the surface there falls, outward, faster than
// the ray can. A horizontal ray is the first to leave; one from the lid falls by 1 - h_j at least on its way.
bool relaxed_cone_leaves(ivec2 way, ivec2 other, ivec2 extent, float height) {
  float right = relievo_outward_height(other + ivec2(1, 0), extent) - height;
  float left = relievo_outward_height(other - ivec2(1, 0), extent) - height;
  float down = relievo_outward_height(other + ivec2(0, 1), extent) - height;
  float up = relievo_outward_height(other - ivec2(0, 1), extent) - height;
  precise float rise = relaxed_cone_least_rise(way.x, right, left) + relaxed_cone_least_rise(way.y, down, up);
  return rise < (relaxed_cone_from_lid == 1 ? height - 1.0 : 0.0);
}

void relaxed_cone_meet_texel(ivec2 texel, ivec2 other, ivec2 extent, float own, inout float narrowest) {
  float height = texelFetch(relievo_height_map, other, 0).r;
  float squared = relievo_walk_squared(relievo_walk_gap(texel, other, other, extent));
  float ratio = relievo_cone_to(squared, height - own, narrowest);
  if (ratio < narrowest && relaxed_cone_leaves(relaxed_cone_way(texel, other, extent), other, extent, height)) narrowest = ratio;
}

float relaxed_cone_exhaustive_search(ivec2 texel, ivec2 extent, float own, float narrowest) {
  for (int y = 0; y < extent.y; ++y) {
    for (int x = 0; x < extent.x; ++x) relaxed_cone_meet_texel(texel, ivec2(x, y), extent, own, narrowest);
  }
  return narrowest;
}

// The least that relaxed_cone_least_rise makes of rises no less than `forth` and `back`, over ways of `first` to `last` texels.
float relaxed_cone_least_of_rises(int first, int last, float forth, float back) {
  float least = 1.0e30;
  if (last >= 0) least = forth * (forth < 0.0 ? float(last) + 0.5 : max(float(first) - 0.5, 0.0));
  if (first <= 0) least = min(least, back * (back < 0.0 ? 0.5 - float(first) : max(-0.5 - float(last), 0.0)));
  return least;
}

// False only where relaxed_cone_leaves is false for every texel of the node. What is added up here for the least rises of them all
// is no more than what is added up there for any, roundings included: they keep order.
bool relaxed_cone_may_leave(PyramidWalk walk, ivec2 texel, ivec2 first, ivec2 last, ivec2 extent, float highest) {
  vec4 rises = relievo_rise_pyramid_at(relievo_walk_node(walk), walk.level);
  ivec2 near = relaxed_cone_way(texel, first, extent), far = relaxed_cone_way(texel, last, extent);
  for (int k = 0; k < 2; ++k) {
    bool turns = far[k] < near[k];  // where the map repeats: some are nearer the other way round
    near[k] = turns ? -extent[k] : near[k];
    far[k] = turns ? extent[k] : far[k];
  }
  precise float rise = relaxed_cone_least_of_rises(near.x, far.x, rises.x, rises.y) +
                       relaxed_cone_least_of_rises(near.y, far.y, rises.z, rises.w);
  return rise < (relaxed_cone_from_lid == 1 ? highest - 1.0 : 0.0);
}

float relaxed_cone_pruned(ivec2 texel, ivec2 extent, float own, float narrowest) {
  PyramidWalk walk = relievo_pyramid_walk(texel);
  while (walk.level < walk.top) {
    ivec2 first, last;
    bool matters = relievo_walk_texels(walk, extent, first, last);
    if (matters) {
      float squared = relievo_walk_squared(relievo_walk_gap(texel, first, last, extent));
      float highest = relievo_max_pyramid_at(relievo_walk_node(walk), walk.level);
      matters = relievo_cone_may_narrow(squared, highest - own, narrowest);
      if (matters && walk.level >= RELIEVO_RISE_PYRAMID_FINEST) matters = relaxed_cone_may_leave(walk, texel, first, last, extent, highest);
    }
    if (matters && walk.level > 0) {
      relievo_walk_descend(walk);
    } else {
      if (matters) relaxed_cone_meet_texel(texel, first, extent, own, narrowest);
      relievo_walk_pass(walk);
    }
  }
  return narrowest;
}

void relievo_bake(ivec2 texel) {
  ivec2 extent = textureSize(relievo_height_map, 0);
  float own = texelFetch(relievo_height_map, texel, 0).r, widest = relievo_cone_widest(extent);
  float narrowest = relaxed_cone_exhaustive == 1 ? relaxed_cone_exhaustive_search(texel, extent, own, widest)
                                                 : relaxed_cone_pruned(texel, extent, own, widest);
  relievo_bake_write(texel, 0, relievo_cone_stored(narrowest, extent));
}
