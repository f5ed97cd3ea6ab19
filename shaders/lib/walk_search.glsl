// What the exact techniques share: a search along a walk that passes over what cannot be hit and solves the cells that may be.
//
// Rays that run side by side are executed in step, so that what one of them does costs all of them. Hence a technique has
// three loops: the innermost passes over cells, the middle one solves a cell when every ray has got to one, and the outer one
// starts the walk anew where it has come far.
#include "walk.glsl"

struct WalkSearch {
  vec2 s;
  int steps;  // still to be spent
  float hit;  // distance from s, or RELIEVO_WALK_NEVER
  bool starts_inside;
  bool ends;  // kept apart from s: a driver may end long loops by itself, and that is no miss
};

WalkSearch relievo_search_start(int max_steps) {
  return WalkSearch(vec2(0.0), max_steps, RELIEVO_WALK_NEVER, false, false);
}

bool relievo_search_is_open(WalkSearch search) {
  return search.steps > 0 && !search.ends && !(search.hit < RELIEVO_WALK_NEVER);
}

// Goes on to where nothing is hit before. Returns false when the innermost loop has to end.
bool relievo_search_pass(Walk walk, inout WalkSearch search, float distance) {
  search.s = relievo_walk_on(search.s, distance);
  search.ends = relievo_walk_left(walk, search.s) <= 0.0;
  return !search.ends && !relievo_walk_is_far(search.s);
}

// Solves the cell at s, from there to its border, which is returned; search.hit says whether it was hit.
float relievo_search_cell(Walk walk, WalkPlace place, vec4 corners, inout WalkSearch search) {
  float border = relievo_walk_border(walk, place);
  search.hit = relievo_walk_solve(walk, place, corners, min(border, max(relievo_walk_left(walk, search.s), 0.0)));
  if (search.hit < RELIEVO_WALK_NEVER) {
    bool is_below = relievo_cell_clearance(corners, vec3(place.fraction, place.height)) < 0.0;
    search.starts_inside = is_below && relievo_walk_t(walk, search.s) == 0.0;
  }
  return border;
}

// Without a hit it goes on to the cell behind; returns false when the middle loop has to end.
bool relievo_search_solve(Walk walk, WalkPlace place, vec4 corners, inout WalkSearch search) {
  float border = relievo_search_cell(walk, place, corners, search);
  if (search.hit < RELIEVO_WALK_NEVER) return false;
  return relievo_search_pass(walk, search, border + RELIEVO_WALK_MARGIN);
}

// What to return without a search: no walk can be made of the ray, or it meets neither lid nor domain.
bool relievo_search_begin(Ray ray, ivec2 extent, out Interval interval, out Walk walk, out Hit hit) {
  if (!relievo_interval(ray, interval)) {
    hit = relievo_beside(ray, interval);
    return false;
  }
  bool is_walk = relievo_walk_start(ray, interval, extent, walk);
  hit = relievo_hit_at(ray, is_walk && !walk.starts_within ? RELIEVO_OUTSIDE : RELIEVO_EXHAUSTED, interval.enter);
  return is_walk && walk.starts_within;
}

Hit relievo_search_result(Ray ray, Interval interval, Walk walk, WalkSearch search) {
  if (search.starts_inside) return relievo_hit_at(ray, RELIEVO_INSIDE, 0.0);
  bool is_hit = search.hit < RELIEVO_WALK_NEVER;
  bool is_at_base = !is_hit && search.ends && interval.end_status == RELIEVO_HIT && relievo_walk_falls(walk);
  if (is_hit || is_at_base) {
    vec2 s = is_at_base ? relievo_walk_on(vec2(0.0), relievo_walk_to_base(walk)) : relievo_walk_on(search.s, search.hit);
    Hit hit = relievo_walk_hit(ray, walk, s);
    if (is_at_base) hit = Hit(RELIEVO_HIT, interval.exit, vec3(hit.point.xy, min(walk.base_height, 0.0)));
    return hit;
  }
  if (search.ends) return relievo_end_of(ray, interval);
  return relievo_hit_at(ray, RELIEVO_EXHAUSTED, clamp(relievo_walk_t(walk, search.s), interval.enter, interval.exit));
}
