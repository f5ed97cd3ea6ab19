// Each step reads, for the cell that the ray is in and the quadrant that it heads for, the greatest heights E over windows of
// 1, n, nr and nr² cells ahead. Within a window the ray cannot meet the surface before it falls to E: it goes on to there or to
// the window's border, whichever comes first, in the window that lets it go furthest. Where not even the cell lets it
// through, the cell is solved.
//
// Rays that run side by side are executed in step, so that what one of them does costs all of them. Hence two loops: the
// inner one only reads windows, and cells are solved outside it, when every ray has got to one.
#include "shaders/lib/walk.glsl"

struct QuadrantMaximaPace {
  vec4 u, v;   // s from a window's begin to its end
  float fall;  // s a unit of H, if the ray falls
};

QuadrantMaximaPace quadrant_maxima_pace(Walk walk) {
  vec4 widths = relievo_quadrant_maxima_widths();
  precise vec4 u = widths * walk.pace.x, v = widths * walk.pace.y;
  precise float fall = 1.0 / max(-walk.rise, 1.0 / RELIEVO_WALK_NEVER);
  return QuadrantMaximaPace(u, v, fall);
}

// How far the ray is let through; `border`: how far it is to the cell's border.
float quadrant_maxima_free(Walk walk, QuadrantMaximaPace pace, WalkPlace place, out float border) {
  vec4 greatest = relievo_quadrant_maxima_at(relievo_fold_cell(place.cell, walk.extent, walk.heading));
  precise vec2 behind = abs(walk.behind_at_zero - place.fraction) * walk.pace;
  precise vec4 borders = min(pace.u - behind.x, pace.v - behind.y);
  precise vec4 sink = (place.height - greatest) * pace.fall;
  vec4 free = min(borders, sink);
  border = borders.x;
  return max(max(free.x, free.y), max(free.z, free.w));
}

Hit quadrant_maxima_trace(Ray ray) {
  Interval interval;
  if (!relievo_interval(ray, interval)) {
    return relievo_hit_at(ray, interval.end_status == RELIEVO_OUTSIDE ? RELIEVO_OUTSIDE : RELIEVO_MISS, 0.0);
  }
  Walk walk;
  if (!relievo_walk_start(ray, interval, textureSize(relievo_cell_corners_map, 0), walk)) {
    return relievo_hit_at(ray, RELIEVO_EXHAUSTED, interval.enter);
  }
  QuadrantMaximaPace pace = quadrant_maxima_pace(walk);
  vec2 s = vec2(0.0);
  int steps = quadrant_maxima_max_steps;
  float hit = RELIEVO_WALK_NEVER;
  bool starts_inside = false;
  bool ends = false;  // kept apart from s: a driver may end long loops by itself, and that is no miss
  while (steps > 0 && !ends) {
    while (steps > 0) {
      while (steps > 0) {
        --steps;
        RELIEVO_COUNT_STEP();
        float border;
        float free = quadrant_maxima_free(walk, pace, relievo_walk_place(walk, s), border);
        if (free < border) break;
        s = relievo_walk_on(s, free + RELIEVO_WALK_MARGIN);
        ends = relievo_walk_left(walk, s) <= 0.0;
        if (ends || relievo_walk_is_far(s)) break;
      }
      if (ends) break;
      WalkPlace place = relievo_walk_place(walk, s);
      vec4 corners = relievo_cell_corners_at(place.cell, walk.extent);
      float border = relievo_walk_border(walk, place);
      hit = relievo_walk_solve(walk, place, corners, min(border, max(relievo_walk_left(walk, s), 0.0)));
      if (hit < RELIEVO_WALK_NEVER) {
        bool is_below = relievo_cell_clearance(corners, vec3(place.fraction, place.height)) < 0.0;
        starts_inside = is_below && relievo_walk_t(walk, s) == 0.0;
        break;
      }
      s = relievo_walk_on(s, border + RELIEVO_WALK_MARGIN);
      ends = relievo_walk_left(walk, s) <= 0.0;
      if (ends || relievo_walk_is_far(s)) break;
    }
    if (hit < RELIEVO_WALK_NEVER) break;
    relievo_walk_rebase(walk, s);
  }
  if (starts_inside) return relievo_hit_at(ray, RELIEVO_INSIDE, 0.0);
  if (hit < RELIEVO_WALK_NEVER) return relievo_walk_hit(ray, walk, relievo_walk_on(s, hit));
  if (ends) return relievo_end_of(ray, interval);
  return relievo_walk_exhausted(ray, interval, walk, s);
}
