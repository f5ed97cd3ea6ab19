// The exact first hit: a maximum pyramid over bilinear cells says what can be passed over, the quadratic of a cell decides.
//
// Within a tile the walk keeps an integer cell and a level. The ray is straight, so over a node it is lowest where it enters
// or leaves; if that is above the node's maximum, the node is passed over, else the walk descends, and at level 0 the cell is
// solved. Leaving a node moves one integer coordinate across its border: no epsilon, no cell twice, none left out.
#include "shaders/lib/cell.glsl"
#include "shaders/lib/search.glsl"
#include "shaders/lib/tile.glsl"

struct ExactWalk {
  TileAxis u, v;
  ivec2 extent;  // cells
  ivec2 cell;
  float t;
  int level;
};

vec2 exact_position(ExactWalk walk, float t) {
  precise vec2 position = vec2(walk.u.a + t * walk.u.b, walk.v.a + t * walk.v.b);
  return position;
}

// First and last cell of a tile along an axis: with repeat 0 … W−1, else also the half cell before texel 0.
int exact_first_cell() {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  return 0;
#else
  return -1;
#endif
}

ivec2 exact_cell_at(ExactWalk walk, float t) {
  vec2 position = exact_position(walk, t);
  vec2 cell = floor(position);
  if (walk.u.b < 0.0 && cell.x == position.x) cell.x -= 1.0;  // on a grid line, the cell that is entered
  if (walk.v.b < 0.0 && cell.y == position.y) cell.y -= 1.0;
  return clamp(ivec2(cell), ivec2(exact_first_cell()), walk.extent - 1);
}

// t where an axis leaves the cells [first, end); the half cell before texel 0 belongs to the first node.
float exact_leave(TileAxis axis, int first, int end) {
  if (axis.b == 0.0) return RELIEVO_NEVER;
  precise float t = (float(axis.b > 0.0 ? end : first) - axis.a) / axis.b;
  return t;
}

// The first hit in the walk's cell between t and `leave`, as t; or RELIEVO_NEVER.
float exact_solve(Ray ray, ExactWalk walk, float leave) {
  precise vec2 from = clamp(exact_position(walk, walk.t) - vec2(walk.cell), 0.0, 1.0);
  precise vec2 to = clamp(exact_position(walk, leave) - vec2(walk.cell), 0.0, 1.0);
  precise float from_height = ray.origin.z + walk.t * ray.direction.z;
  precise float to_height = ray.origin.z + leave * ray.direction.z;
  float share = relievo_cell_hit(relievo_height_corners(vec2(walk.cell), vec2(walk.extent)), vec3(from, from_height), vec3(to, to_height));
  return share <= 1.0 ? walk.t + share * (leave - walk.t) : RELIEVO_NEVER;
}

// Walks one tile up to `end`. Returns true with t of the first hit; steps count down to exhaustion.
bool exact_walk_tile(Ray ray, inout ExactWalk walk, float end, int top, inout int steps) {
  int first_cell = exact_first_cell();
  while (steps > 0) {
    --steps;
    RELIEVO_COUNT_STEP();
    ivec2 node = max(walk.cell, ivec2(0)) >> walk.level;
    ivec2 first = node << walk.level;
    ivec2 last = first + (1 << walk.level);
    if (walk.level == 0) {
      first = walk.cell;
      last = walk.cell + 1;
    } else {
      if (node.x == 0) first.x = first_cell;
      if (node.y == 0) first.y = first_cell;
    }
    float leave_u = exact_leave(walk.u, first.x, last.x);
    float leave_v = exact_leave(walk.v, first.y, last.y);
    float leave = max(min(min(leave_u, leave_v), end), walk.t);
    precise float enter_height = ray.origin.z + walk.t * ray.direction.z;
    precise float leave_height = ray.origin.z + leave * ray.direction.z;
    float highest = relievo_max_pyramid_at(node, walk.level);
    if (min(enter_height, leave_height) <= highest) {
      if (walk.level > 0) {
        if (enter_height > highest) {  // falls to the maximum within the node: nothing is hit before
          precise float reach = (highest - ray.origin.z) / ray.direction.z;
          walk.t = clamp(reach, walk.t, leave);
          walk.cell = clamp(exact_cell_at(walk, walk.t), first, min(last, walk.extent) - 1);
        }
        walk.level -= 1;
        continue;
      }
      float hit = exact_solve(ray, walk, leave);
      if (hit < RELIEVO_NEVER) {
        walk.t = hit;
        return true;
      }
    }
    walk.t = leave;
    if (leave >= end) return false;
    ivec2 next = clamp(exact_cell_at(walk, leave), first, min(last, walk.extent) - 1);
    if (leave_u <= leave_v) next.x = walk.u.b > 0.0 ? last.x : first.x - 1;
    if (leave_v <= leave_u) next.y = walk.v.b > 0.0 ? last.y : first.y - 1;
    // Rounding may put the border of the last cell a little before the tile's: the integers decide that the tile is left.
    if (next.x < first_cell || next.x >= walk.extent.x) walk.u.leave = leave;
    if (next.y < first_cell || next.y >= walk.extent.y) walk.v.leave = leave;
    if (min(walk.u.leave, walk.v.leave) <= leave) return false;
    walk.cell = next;
    walk.level = min(walk.level + 1, top);
  }
  return false;
}

Hit exact_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  ExactWalk walk;
  walk.extent = textureSize(relievo_height_map, 0);
  walk.t = interval.enter;
  vec2 extent = vec2(walk.extent);
  vec3 entry = relievo_entry_point(ray, interval);
  ivec2 tile = ivec2(relievo_tile_of(entry.x, ray.direction.x, relievo_tile_shift(extent.x)),
                     relievo_tile_of(entry.y, ray.direction.y, relievo_tile_shift(extent.y)));
  int top = relievo_max_pyramid_top();
  int steps = exact_max_steps;
  while (steps > 0) {
    --steps;
    walk.u = relievo_tile_axis(ray.origin.x, ray.direction.x, extent.x, tile.x);
    walk.v = relievo_tile_axis(ray.origin.y, ray.direction.y, extent.y, tile.y);
    walk.cell = exact_cell_at(walk, walk.t);
    walk.level = min(exact_start_level, top);
    float end = max(min(min(walk.u.leave, walk.v.leave), interval.exit), walk.t);
    if (exact_walk_tile(ray, walk, end, top, steps)) return relievo_hit_at(ray, RELIEVO_HIT, walk.t);
    if (steps > 0 && walk.t >= interval.exit) return relievo_end_of(ray, interval);
    if (walk.u.leave <= walk.t) tile.x += ray.direction.x > 0.0 ? 1 : -1;
    if (walk.v.leave <= walk.t) tile.y += ray.direction.y > 0.0 ? 1 : -1;
  }
  return relievo_hit_at(ray, RELIEVO_EXHAUSTED, walk.t);
}
