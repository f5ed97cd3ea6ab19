// The exact first hit: a maximum pyramid over bilinear cells says what can be passed over, the quadratic of a cell decides.
//
// The ray is straight, so it leaves a node unhurt if it stays above the node's maximum up to the border; the walk then tries
// the next coarser node. Else it goes on to where it sinks to the maximum, and descends. At level 0 the cell is solved.
#include "shaders/lib/walk_search.glsl"

// Cells of the node that lie ahead of this one, along each axis, and before them those that are one with it; nodes end where
// the map does. What a clamped map has beyond its edge is bounded by the outermost nodes, without end.
vec2 exact_cells_ahead(Walk walk, vec2 cell, FoldedCell folded, ivec2 node, int level) {
  vec2 extent = walk.extent;
  vec2 first = vec2(node << level);
  vec2 last = min(vec2((node + 1) << level), extent) - 1.0;
  bvec2 forward = greaterThanEqual(folded.heading, vec2(0.0));
  vec2 ahead = relievo_walk_same_ahead(walk, cell) + mix(folded.cell - first, last - folded.cell, vec2(forward));
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLAMP || RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLIP
  bvec2 outermost = bvec2(forward.x ? last.x == extent.x - 1.0 : node.x == 0, forward.y ? last.y == extent.y - 1.0 : node.y == 0);
  ahead = mix(ahead, vec2(RELIEVO_MAX_TRAVEL * 16384.0), vec2(outermost));
#endif
  return ahead;
}

// A way over many cells may end behind the node, and what lies there between two steps is not looked at: 8 roundings of 2^-24 are
// taken off it, the quotient being 2.5 ulp, beyond so many cells that they matter (3e-5 texel).
const float EXACT_ROUNDING = 6.0e-7;
const float EXACT_FEW_CELLS = 63.0;

// How far the ray is let through within the node of `level`; `border`: how far it is to the node's border.
float exact_free(Walk walk, WalkPlace place, float fall, int level, out float border) {
  FoldedCell folded = relievo_fold_cell(place.cell, walk.extent, walk.heading);
  ivec2 node = ivec2(folded.cell) >> level;
  float greatest = relievo_max_pyramid_at(node, level);
  vec2 behind = abs(walk.behind_at_zero - place.fraction);
  vec2 ahead = exact_cells_ahead(walk, place.cell, folded, node, level);
  vec2 lost = EXACT_ROUNDING * max(ahead - EXACT_FEW_CELLS, vec2(0.0));
  precise vec2 borders = ((ahead - lost) + (RELIEVO_WALK_ACROSS - behind)) * walk.pace;
  precise float sink = (place.height - greatest) * fall;
  border = min(borders.x, borders.y);
  return min(border, sink);
}

Hit exact_trace(Ray ray) {
  Interval interval;
  Walk walk;
  Hit hit;
  if (!relievo_search_begin(ray, textureSize(relievo_height_map, 0), interval, walk, hit)) return hit;
  precise float fall = 1.0 / max(-walk.rise, 1.0 / RELIEVO_WALK_NEVER);
  int top = relievo_max_pyramid_top();
  int level = min(exact_start_level, top);
  WalkSearch search = relievo_search_start(exact_max_steps);
  while (relievo_search_is_open(search)) {
    while (search.steps > 0) {
      while (search.steps > 0) {
        --search.steps;
        RELIEVO_COUNT_STEP();
        float border;
        float free = exact_free(walk, relievo_walk_place(walk, search.s), fall, level, border);
        bool passes = free >= border;
        if (!passes && level == 0) break;
        level = passes ? min(level + 1, top) : level - 1;
        if (!passes && free <= 0.0) continue;  // descends where it stands
        if (!relievo_search_pass(walk, search, passes ? border + RELIEVO_WALK_MARGIN : free)) break;
      }
      if (search.ends || level > 0) break;
      WalkPlace place = relievo_walk_place(walk, search.s);
      bool goes_on = relievo_search_solve(walk, place, relievo_height_corners(place.cell, walk.extent), search);
      level = min(1, top);
      if (!goes_on) break;
    }
    if (relievo_search_is_open(search)) relievo_walk_rebase(walk, search.s);
  }
  return relievo_search_result(ray, interval, walk, search);
}
