// The exact first hit: a maximum pyramid over bilinear cells says what can be passed over, the quadratic of a cell decides.
//
// The ray is straight, so it leaves a node unhurt if it stays above the node's maximum up to the border; the walk then tries
// the next coarser node. Else it goes on to where it sinks to the maximum, and descends. At level 0 the cell is solved.
// As in techniques/quadrant_maxima, cells are solved outside the loop that looks for them.
#include "shaders/lib/walk.glsl"

// Cells of the node that lie ahead of this one, along each axis; nodes end where the map does. What a clamped map has
// beyond its edge is bounded by the outermost nodes, without end.
vec2 exact_cells_ahead(FoldedCell folded, ivec2 node, int level, vec2 extent) {
  vec2 first = vec2(node << level);
  vec2 last = min(vec2((node + 1) << level), extent) - 1.0;
  bvec2 forward = greaterThanEqual(folded.heading, vec2(0.0));
  vec2 ahead = mix(folded.cell - first, last - folded.cell, vec2(forward));
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLAMP || RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLIP
  bvec2 outermost = bvec2(forward.x ? last.x == extent.x - 1.0 : node.x == 0, forward.y ? last.y == extent.y - 1.0 : node.y == 0);
  ahead = mix(ahead, vec2(RELIEVO_MAX_TRAVEL * 16384.0), vec2(outermost));
#endif
  return ahead;
}

// How far the ray is let through within the node of `level`; `border`: how far it is to the node's border.
float exact_free(Walk walk, WalkPlace place, float fall, int level, out float border) {
  FoldedCell folded = relievo_fold_cell(place.cell, walk.extent, walk.heading);
  ivec2 node = ivec2(folded.cell) >> level;
  float greatest = relievo_max_pyramid_at(node, level);
  vec2 behind = abs(walk.behind_at_zero - place.fraction);
  precise vec2 borders = (exact_cells_ahead(folded, node, level, walk.extent) + (1.0 - behind)) * walk.pace;
  precise float sink = (place.height - greatest) * fall;
  border = min(borders.x, borders.y);
  return min(border, sink);
}

Hit exact_trace(Ray ray) {
  Interval interval;
  if (!relievo_interval(ray, interval)) {
    return relievo_hit_at(ray, interval.end_status == RELIEVO_OUTSIDE ? RELIEVO_OUTSIDE : RELIEVO_MISS, 0.0);
  }
  Walk walk;
  if (!relievo_walk_start(ray, interval, textureSize(relievo_height_map, 0), walk)) {
    return relievo_hit_at(ray, RELIEVO_EXHAUSTED, interval.enter);
  }
  precise float fall = 1.0 / max(-walk.rise, 1.0 / RELIEVO_WALK_NEVER);
  int top = relievo_max_pyramid_top();
  int level = min(exact_start_level, top);
  vec2 s = vec2(0.0);
  int steps = exact_max_steps;
  float hit = RELIEVO_WALK_NEVER;
  bool starts_inside = false;
  bool ends = false;
  while (steps > 0 && !ends) {
    while (steps > 0) {
      while (steps > 0) {
        --steps;
        RELIEVO_COUNT_STEP();
        float border;
        float free = exact_free(walk, relievo_walk_place(walk, s), fall, level, border);
        bool passes = free >= border;
        if (!passes && level == 0) break;
        s = relievo_walk_on(s, passes ? border + RELIEVO_WALK_MARGIN : max(free, 0.0));
        level = passes ? min(level + 1, top) : level - 1;
        ends = free > 0.0 && relievo_walk_left(walk, s) <= 0.0;  // descending where it stands says nothing of an end
        if (ends || relievo_walk_is_far(s)) break;
      }
      if (ends || level > 0) break;
      WalkPlace place = relievo_walk_place(walk, s);
      vec4 corners = relievo_height_corners(place.cell, walk.extent);
      float border = relievo_walk_border(walk, place);
      hit = relievo_walk_solve(walk, place, corners, min(border, max(relievo_walk_left(walk, s), 0.0)));
      if (hit < RELIEVO_WALK_NEVER) {
        bool is_below = relievo_cell_clearance(corners, vec3(place.fraction, place.height)) < 0.0;
        starts_inside = is_below && relievo_walk_t(walk, s) == 0.0;
        break;
      }
      s = relievo_walk_on(s, border + RELIEVO_WALK_MARGIN);
      level = min(1, top);
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
