// Policarpo and Oliveira 2007, without marching rays: a ray that falls away from the axis of the cone leaves the surface where the
// surface falls faster. The cone on texel i is as wide as the texels j that fall away from it allow, min of
// |x_j - x_i| / (h_j - h_i). Slopes that rise away from texel i do not count: a ray enters there. Units as in the classic map.
#include "shaders/lib/pyramid_walk.glsl"

bool relaxed_cone_narrows(float squared, float rise, float narrowest) {
  precise float reach = narrowest * rise * rise;
  return rise > 0.0 && squared < reach;
}

// From one texel to the nearest image of another.
ivec2 relaxed_cone_way(ivec2 texel, ivec2 other, ivec2 extent) {
  ivec2 way = other - texel;
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  way -= extent * ivec2(greaterThan(2 * way, extent));
  way += extent * ivec2(lessThan(2 * way, -extent));
#endif
  return way;
}

// The height of the next texel outward along one axis. Beyond the edge of a mirrored map what rises falls again: it counts as a
// fall there, which may only narrow the cone.
float relaxed_cone_outward(ivec2 texel, ivec2 extent) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, extent))) return 0.0;
#endif
  return relievo_height_texel(texel, extent);
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
  float right = relaxed_cone_outward(other + ivec2(1, 0), extent) - height;
  float left = relaxed_cone_outward(other - ivec2(1, 0), extent) - height;
  float down = relaxed_cone_outward(other + ivec2(0, 1), extent) - height;
  float up = relaxed_cone_outward(other - ivec2(0, 1), extent) - height;
  precise float rise = relaxed_cone_least_rise(way.x, right, left) + relaxed_cone_least_rise(way.y, down, up);
  return rise < (relaxed_cone_from_lid == 1 ? height - 1.0 : 0.0);
}

void relaxed_cone_meet_texel(ivec2 texel, ivec2 other, ivec2 extent, float own, inout float narrowest) {
  float height = texelFetch(relievo_height_map, other, 0).r;
  float squared = relievo_walk_squared(relievo_walk_gap(texel, other, other, extent));
  if (!relaxed_cone_narrows(squared, height - own, narrowest)) return;
  precise float ratio = squared / ((height - own) * (height - own));
  if (relaxed_cone_leaves(relaxed_cone_way(texel, other, extent), other, extent, height)) narrowest = ratio;
}

float relaxed_cone_exhaustive_search(ivec2 texel, ivec2 extent, float own, float narrowest) {
  for (int y = 0; y < extent.y; ++y) {
    for (int x = 0; x < extent.x; ++x) relaxed_cone_meet_texel(texel, ivec2(x, y), extent, own, narrowest);
  }
  return narrowest;
}

float relaxed_cone_pruned(ivec2 texel, ivec2 extent, float own, float narrowest) {
  PyramidWalk walk = relievo_pyramid_walk(texel);
  while (walk.level < walk.top) {
    ivec2 first, last;
    bool matters = relievo_walk_texels(walk, extent, first, last);
    if (matters) {
      float squared = relievo_walk_squared(relievo_walk_gap(texel, first, last, extent));
      float rise = relievo_max_pyramid_at(relievo_walk_node(walk), walk.level) - own;
      matters = relaxed_cone_narrows(squared, rise, narrowest);
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
  float longest = float(max(extent.x, extent.y));
  float own = texelFetch(relievo_height_map, texel, 0).r;
  float widest = longest * longest;
  float narrowest = relaxed_cone_exhaustive == 1 ? relaxed_cone_exhaustive_search(texel, extent, own, widest)
                                                 : relaxed_cone_pruned(texel, extent, own, widest);
  // Four roundings up to here, each under 2^-23; a cone may only be too narrow.
  precise float ratio = sqrt(narrowest) / longest * 0.9999995;
  precise float encoded = sqrt(ratio) * 0.9999995;
  relievo_bake_write(texel, 0, encoded);
}
