// Each step reads, for the cell that the ray is in and the quadrant that it heads for, the greatest heights E over windows of
// 1, r, r² and r³ cells ahead. Within a window the ray cannot meet the surface before it falls to E: it goes on to there or to
// the window's border, whichever comes first, in the window that lets it go furthest. Where not even the cell lets it
// through, the cell is solved.
//
// Rays that run side by side are executed in step, so that what one of them does costs all of them. Hence two loops: the
// inner one only reads windows, and cells are solved outside it, when every ray has got to one.
#include "shaders/lib/walk.glsl"

struct QuadrantMaximaRay {
  vec2 heading;
  vec2 pace;   // s a cell
  float fall;  // s a unit of H; without end for rays that do not fall
  vec4 widths;
};

QuadrantMaximaRay quadrant_maxima_ray(Walk walk) {
  QuadrantMaximaRay constants;
  constants.heading = mix(vec2(-1.0), vec2(1.0), greaterThanEqual(walk.slope, vec2(0.0)));
  precise vec2 pace = 1.0 / max(abs(walk.slope), vec2(1.0 / RELIEVO_WALK_NEVER));
  precise float fall = 1.0 / max(-walk.rise, 1.0 / RELIEVO_WALK_NEVER);
  constants.pace = pace;
  constants.fall = fall;
  constants.widths = relievo_quadrant_maxima_widths();
  return constants;
}

// How far the ray is let through from where it is; `border`: how far it is to the cell's border.
float quadrant_maxima_free(Walk walk, QuadrantMaximaRay constants, out float border) {
  vec4 greatest = relievo_quadrant_maxima_at(relievo_fold_cell(walk.cell, walk.extent, constants.heading));
  vec2 inside = mix(1.0 - walk.fraction, walk.fraction, greaterThanEqual(constants.heading, vec2(0.0)));
  precise vec4 borders =
      min((constants.widths - inside.x) * constants.pace.x, (constants.widths - inside.y) * constants.pace.y);
  precise vec4 sink = (walk.height - greatest) * constants.fall;
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
  if (relievo_walk_starts_inside(interval, walk)) return relievo_hit_at(ray, RELIEVO_INSIDE, 0.0);
  QuadrantMaximaRay constants = quadrant_maxima_ray(walk);
  int steps = quadrant_maxima_max_steps;
  while (steps > 0) {
    float border = 0.0;
    while (steps > 0) {
      --steps;
      RELIEVO_COUNT_STEP();
      float free = quadrant_maxima_free(walk, constants, border);
      if (free < border) break;
      relievo_walk_on(walk, free + RELIEVO_WALK_MARGIN);
      if (relievo_walk_left(walk) <= 0.0) return relievo_end_of(ray, interval);
    }
    if (steps == 0) break;
    vec4 corners = relievo_cell_corners_at(walk.cell, walk.extent);
    float hit = relievo_walk_solve(walk, corners, min(border, relievo_walk_left(walk)));
    if (hit < RELIEVO_WALK_NEVER) return relievo_walk_hit(ray, walk, hit);
    relievo_walk_on(walk, border + RELIEVO_WALK_MARGIN);
    if (relievo_walk_left(walk) <= 0.0) return relievo_end_of(ray, interval);
  }
  return relievo_hit_at(ray, RELIEVO_EXHAUSTED, relievo_walk_t(walk));
}
