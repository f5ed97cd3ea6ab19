// Each step reads, for the cell that the ray is in and the quadrant that it heads for, the greatest heights E over four windows
// ahead and the cell's corners. Within a window the ray cannot meet the surface before it falls to E: it goes on to there
// or to the window's border, whichever comes first, in the window that lets it go furthest. It also leaves its cell where
// it clears the patch between the corners. Where nothing lets it through, the cell is solved.
//
// Between two solved cells the ray glides: from a place that is known exactly, by a distance in one float. What rounding
// can do over that distance is taken off the ray's height, so that a glide errs on the safe side; the cells it ends in
// are solved from their exact place. A step's cost is the time until its result is there, hence whole numbers where
// they are quicker: floats that are not negative are ordered as their bits are.
#include "shaders/lib/walk_search.glsl"

const float QUADRANT_MAXIMA_REACH = 512.0;      // s: a glide goes no further, nor beyond a period
const float QUADRANT_MAXIMA_ROUNDING = 2.5e-6;  // of H, a unit of s: see README.md
const float QUADRANT_MAXIMA_HEIGHT = 5.0e-6;    // of H: likewise, however short the glide
const float QUADRANT_MAXIMA_MARGIN = 2.0e-7;    // s a unit of s, to get across a border

// Fixed for a ray, in the units in which the map's heights are compared.
struct GlidePace {
  vec2 slope;         // cells a unit of s, towards the quadrant
  float fall;         // s a unit of height, if the ray falls
  float rise, climb;  // height a unit of s; climb is 0 if the ray falls
};

// From one exact place; what a step needs is made here, once.
struct Glide {
  ivec2 base, turn;  // cell where it starts; from there to the same cell one period back
  ivec2 against;     // −1 along an axis that is headed for backwards, else 0
  vec2 ahead;        // cells from the near corner of `base`, towards the quadrant
  vec4 u, v;         // s where the windows at `base` are left along each axis
  vec2 cell;         // and its cell
  float top;         // height where it starts, less what rounding can do
  float left;        // s where it ends at the latest
  float margin;      // s to get across a border
};

GlidePace quadrant_maxima_pace(Walk walk) {
  precise float fall = 1.0 / (RELIEVO_QUADRANT_MAXIMA_UNIT * max(-walk.rise, 1.0 / RELIEVO_WALK_NEVER));
  precise float rise = RELIEVO_QUADRANT_MAXIMA_UNIT * walk.rise;
  return GlidePace(abs(walk.slope), fall, rise, max(rise, 0.0));
}

Glide quadrant_maxima_glide(Walk walk, vec2 s, WalkPlace place) {
  vec4 widths = relievo_quadrant_maxima_widths();
  Glide glide;
  glide.against = ivec2(min(walk.heading, 0.0));
  glide.base = ivec2(relievo_fold_to_first_period(place.cell, walk.extent)) - glide.against;
  glide.turn = ivec2(walk.heading * walk.extent);
  glide.ahead = abs(walk.behind_at_zero - place.fraction);
  precise vec4 u = (widths - glide.ahead.x) * walk.pace.x, v = (widths - glide.ahead.y) * walk.pace.y;
  precise vec2 cell = (1.0 - glide.ahead) * walk.pace;
  glide.u = u;
  glide.v = v;
  glide.cell = cell;
  precise vec2 period = (walk.extent - 0.5) * walk.pace;
  float reach = min(min(period.x, period.y), QUADRANT_MAXIMA_REACH);
  float left = relievo_walk_left(walk, s);
  glide.left = min(left, reach);
  // With the step that ends the glide, a whole window at most.
  precise float longest = min(left, reach + widths.w * min(walk.pace.x, walk.pace.y));
  precise float height = place.height - (QUADRANT_MAXIMA_ROUNDING * longest + QUADRANT_MAXIMA_HEIGHT);
  precise float top = 1.0 + RELIEVO_QUADRANT_MAXIMA_UNIT * height;
  glide.top = top;
  glide.margin = QUADRANT_MAXIMA_MARGIN * max(glide.left, 16.0);
  return glide;
}

// What the map has of a cell, folded back into it.
QuadrantMaxima quadrant_maxima_of(Walk walk, Glide glide, ivec2 cell) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  // One of the two is within the map. The other is larger, or negative, which is larger still without a sign.
  cell = ivec2(min(uvec2(cell), uvec2(cell - glide.turn)));
  return relievo_quadrant_maxima_at(cell, relievo_quadrant(walk.heading));
#else
  FoldedCell folded = relievo_fold_cell(vec2(cell), walk.extent, walk.heading);
  return relievo_quadrant_maxima_at(ivec2(folded.cell), relievo_quadrant(folded.heading));
#endif
}

// The patch along a ray that crosses its cell is a quadratic, which its control points bound: the corners weighted
// by where the ray is, by where it leaves, and by one of either in u and the other in v. Returned is a number whose sign bit is
// set unless the ray stays above all three.
int quadrant_maxima_clears(vec4 corners, vec3 place, vec3 way) {
  precise vec3 end = place + way;
  precise vec4 at = vec4(1.0 - place.xy, place.xy), left = vec4(1.0 - end.xy, end.xy);
  precise vec4 first = at.xzxz * at.yyww, last = left.xzxz * left.yyww;
  precise vec4 twice_middle = at.xzxz * left.yyww + left.xzxz * at.yyww;
  first *= corners;
  twice_middle *= corners;
  last *= corners;
  precise float a = place.z - ((first.x + first.y) + (first.z + first.w));
  precise float b = (place.z + end.z) - ((twice_middle.x + twice_middle.y) + (twice_middle.z + twice_middle.w));
  precise float c = end.z - ((last.x + last.y) + (last.z + last.w));
  return floatBitsToInt(a) | floatBitsToInt(b) | floatBitsToInt(c);
}

// The s that the ray may go to from `s`, in bits; `border`: where it leaves the cell.
int quadrant_maxima_free(Walk walk, Glide glide, GlidePace pace, float s, out int border) {
  precise vec2 at = glide.ahead + s * pace.slope;
  ivec2 passed = ivec2(at);
  ivec2 here = glide.base + (passed ^ glide.against);
  QuadrantMaxima maxima = quadrant_maxima_of(walk, glide, here);

  precise vec2 before = vec2(passed) * walk.pace;
  precise vec4 u = glide.u + before.x, v = glide.v + before.y;
  precise vec2 cell = glide.cell + before;
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLAMP
  cell += min(relievo_walk_same_ahead(walk, vec2(here)), relievo_quadrant_maxima_widths().w - 1.0) * walk.pace;
#endif
  precise vec4 sink = (glide.top + s * pace.climb - maxima.windows) * pace.fall;
  ivec4 free = min(min(floatBitsToInt(u), floatBitsToInt(v)), floatBitsToInt(sink));
  border = min(floatBitsToInt(cell.x), floatBitsToInt(cell.y));

  precise float height = glide.top + s * pace.rise;
  precise float to_border = intBitsToFloat(border) - s;
  precise vec3 way = to_border * vec3(pace.slope, pace.rise);
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  precise vec2 within = at - vec2(passed);
  int clears = quadrant_maxima_clears(maxima.corners, vec3(within, height), way);
#else
  // Cells beyond the edges are not the patch between these corners, but have no other corners than these.
  float highest = max(max(maxima.corners.x, maxima.corners.y), max(maxima.corners.z, maxima.corners.w));
  precise float clearance = height + min(way.z, 0.0) - highest;
  int clears = floatBitsToInt(clearance);
#endif
  return max(max(max(free.x, free.y), max(free.z, free.w)), border | (clears >> 31));
}

// Glides on from `s`; false when it is at the glide's end. True: nothing lets the ray through there.
bool quadrant_maxima_is_blocked(Walk walk, Glide glide, GlidePace pace, inout int steps, inout float s) {
  int left = floatBitsToInt(glide.left);
  int free, needed;  // s that the ray may go to, and that it must to be let through
  float from;
  bool goes_on;
  do {
    --steps;
    RELIEVO_COUNT_STEP();
    int border;
    free = quadrant_maxima_free(walk, glide, pace, s, border);
    needed = max(border, floatBitsToInt(s));
    from = s;
    s = intBitsToFloat(free) + glide.margin;
    // The next step waits for this: one comparison, needed <= free < limit.
    int limit = steps > 0 ? max(left, needed) : needed;
    goes_on = uint(free) - uint(needed) < uint(limit) - uint(needed);
  } while (goes_on);
  bool is_blocked = free < needed;
  s = is_blocked ? from : intBitsToFloat(max(free, needed)) + glide.margin;
  return is_blocked;
}

Hit quadrant_maxima_trace(Ray ray) {
  Interval interval;
  Walk walk;
  Hit hit;
  if (!relievo_search_begin(ray, textureSize(relievo_cell_corners_map, 0), interval, walk, hit)) return hit;
  GlidePace pace = quadrant_maxima_pace(walk);
  WalkSearch search = relievo_search_start(quadrant_maxima_max_steps);
  WalkPlace place = WalkPlace(walk.base_cell, walk.base_fraction, walk.base_height);  // known exactly
  float on = 0.0;                                                                    // s from there
  while (relievo_search_is_open(search)) {
    bool is_blocked = quadrant_maxima_is_blocked(walk, quadrant_maxima_glide(walk, search.s, place), pace, search.steps, on);
    search.s = relievo_walk_on(search.s, on);
    on = 0.0;
    place = relievo_walk_place(walk, search.s);
    if (relievo_walk_is_far(search.s)) relievo_walk_rebase_to(place, walk, search.s);
    if (is_blocked) {
      // The next glide starts here and not behind the cell, so that it need not wait for the solution to be prepared.
      float border = relievo_search_cell(walk, place, relievo_cell_corners_at(place.cell, walk.extent), search);
      on = border + RELIEVO_WALK_MARGIN;
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLAMP
      // Beyond the edge that may be many cells, further than a glide goes.
      if (!(search.hit < RELIEVO_WALK_NEVER) && on > 2.0 * min(walk.pace.x, walk.pace.y)) {
        search.s = relievo_walk_on(search.s, on);
        place = relievo_walk_place(walk, search.s);
        on = 0.0;
      }
#endif
    }
    search.ends = relievo_walk_left(walk, search.s) <= on;
  }
  return relievo_search_result(ray, interval, walk, search);
}
