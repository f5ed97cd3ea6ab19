// Each step reads, of the cell that the ray is in, the cone for the sector that it heads for, and goes as far as the cone lets
// the ray through. Where that is not even out of the cell, the cell is solved.
#include "shaders/lib/cone.glsl"

Hit directional_cone_trace(Ray ray) {
  Interval interval;
  Walk walk;
  Hit hit;
  if (!relievo_search_begin(ray, textureSize(relievo_cell_corners_map, 0), interval, walk, hit)) return hit;
  ConeRay constants = relievo_cone_ray(walk, directional_cone_reach);
  int slice = relievo_sector_slice(walk.slope, directional_cone_sectors);
  WalkSearch search = relievo_search_start(directional_cone_max_steps);
  while (relievo_search_is_open(search)) {
    while (search.steps > 0) {
      while (search.steps > 0) {
        --search.steps;
        RELIEVO_COUNT_STEP();
        WalkPlace place = relievo_walk_place(walk, search.s);
        vec3 cone = relievo_directional_cone_at(relievo_fold_cell(place.cell, walk.extent, walk.heading), slice);
        float border = relievo_walk_border(walk, place);
        float free = relievo_cone_free(walk, place, constants, cone, border);
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
