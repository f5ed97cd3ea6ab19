// Cones over cells: what the maps of robust_cone and directional_cone promise, and how far a ray is let through by it.
//
// A cone's texel says of a cell c: M, the greatest height in c; A, the greatest in c and in the cells that touch it; and √s,
// of the slope s: for every cell d at the distance g >= 1 from c, as far as the map's reach, nothing in d is above A + s g.
// g is the distance of the two squares in the max norm, in cells: a whole number.
#include "cone_slope.glsl"
#include "walk_search.glsl"

// What stays the same along a ray.
struct ConeRay {
  float fall;    // s a unit of H; without end for rays that do not fall
  float spread;  // cells a unit of s, in the max norm
  float reach;   // s from a cell's border on for which its cone holds
};

// `reach`: of the map, in cells.
ConeRay relievo_cone_ray(Walk walk, int reach) {
  precise float fall = 1.0 / max(-walk.rise, 1.0 / RELIEVO_WALK_NEVER);
  return ConeRay(fall, max(abs(walk.slope.x), abs(walk.slope.y)), float(reach) * min(walk.pace.x, walk.pace.y));
}

// How far the ray is let through by `cone` = (M, A, √s). Less than `border`, the way to the cell's border, means that it may
// meet the surface in the cell.
//
// From the border on, the ray is at most spread · (way from the border) cells away from c, so it stays above the cone as
// long as height + rise x > A + s spread (x - border). This holds up to the root x of that if it holds at the border. That is
// asked, and of where the ray is too, since a rising ray may come from below; so within c it is above A, hence above M. The
// margin keeps touching from passing for above.
float relievo_cone_free(Walk walk, WalkPlace place, ConeRay constants, vec3 cone, float border) {
  precise float in_cell = min(border, (place.height - cone.x) * constants.fall);
  precise float widening = relievo_cone_decode(cone.z) * constants.spread;
  precise float above = (place.height - cone.y) + widening * border;
  precise float met = above / max(widening - walk.rise, 1.0 / RELIEVO_WALK_FAR) * (1.0 - RELIEVO_CONE_MARGIN);
  precise float at_border = place.height + walk.rise * border;
  return min(place.height, at_border) > cone.y ? max(in_cell, min(met, border + constants.reach)) : in_cell;
}
