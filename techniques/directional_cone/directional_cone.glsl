// Each step reads, of the cell that the ray is in, the cone for the sector that it heads for, and goes as far as the cone lets
// the ray through. Where that is not even out of the cell, the cell is solved.
//
// Rays that run side by side are executed in step, so that what one of them does costs all of them. Hence two loops: the
// inner one only reads cones, and cells are solved outside it, when every ray has got to one.
#include "shaders/lib/cone.glsl"

Hit directional_cone_trace(Ray ray) {
  Interval interval;
  if (!relievo_interval(ray, interval)) {
    return relievo_hit_at(ray, interval.end_status == RELIEVO_OUTSIDE ? RELIEVO_OUTSIDE : RELIEVO_MISS, 0.0);
  }
  Walk walk;
  if (!relievo_walk_start(ray, interval, textureSize(relievo_cell_corners_map, 0), walk)) {
    return relievo_hit_at(ray, RELIEVO_EXHAUSTED, interval.enter);
  }
  if (relievo_walk_starts_inside(interval, walk)) return relievo_hit_at(ray, RELIEVO_INSIDE, 0.0);
  ConeRay constants = relievo_cone_ray(walk);
  int slice = relievo_sector_slice(walk.slope, directional_cone_sectors);
  int steps = directional_cone_max_steps;
  while (steps > 0) {
    float border = 0.0;
    while (steps > 0) {
      --steps;
      RELIEVO_COUNT_STEP();
      vec3 cone = relievo_directional_cone_at(relievo_fold_cell(walk.cell, walk.extent, constants.heading), slice);
      border = relievo_cone_border(walk, constants);
      float free = relievo_cone_free(walk, constants, cone, border, float(directional_cone_reach));
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
