// Each step reads, for the cell that the ray is in and the quadrant that it heads for, the greatest heights E over windows of
// 1, n, nr and nr² cells ahead. Within a window the ray cannot meet the surface before it falls to E: it goes on to there or to
// the window's border, whichever comes first, in the window that lets it go furthest. Where not even the cell lets it
// through, the cell is solved.
#include "shaders/lib/walk_search.glsl"

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
  Walk walk;
  Hit hit;
  if (!relievo_search_begin(ray, textureSize(relievo_cell_corners_map, 0), interval, walk, hit)) return hit;
  QuadrantMaximaPace pace = quadrant_maxima_pace(walk);
  WalkSearch search = relievo_search_start(quadrant_maxima_max_steps);
  while (relievo_search_is_open(search)) {
    while (search.steps > 0) {
      while (search.steps > 0) {
        --search.steps;
        RELIEVO_COUNT_STEP();
        float border;
        float free = quadrant_maxima_free(walk, pace, relievo_walk_place(walk, search.s), border);
        if (free < border || !relievo_search_pass(walk, search, free + RELIEVO_WALK_MARGIN)) break;
      }
      if (search.ends) break;
      WalkPlace place = relievo_walk_place(walk, search.s);
      if (!relievo_search_solve(walk, place, relievo_cell_corners_at(place.cell, walk.extent), search)) break;
    }
    if (relievo_search_is_open(search)) relievo_walk_rebase(walk, search.s);
  }
  return relievo_search_result(ray, interval, walk, search);
}
