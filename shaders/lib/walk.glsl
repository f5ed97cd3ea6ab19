// A ray as a walk over cells, with its position kept relative to the cell that it is in: at texel 10000 of a map the place
// within a cell is as exact as at texel 0, which float coordinates of the whole map are not.
//
// The walk's parameter s is scaled so that no coordinate moves by more than 1 (texels, or H) a unit. s = whole + part: the
// whole part times the leading 12 bits of the direction is exact, what remains is small, so nothing is lost in their sum.
#include "cell.glsl"
#include "fold.glsl"
#include "interval.glsl"

struct Walk {
  vec2 extent;         // texels
  vec2 base_cell;      // of the point at s = 0
  vec2 base_fraction;  // in [0, 1)
  float base_height;
  float base_t;
  vec2 lead, rest;     // the direction in cells: lead has 12 bits
  vec2 slope;          // lead + rest, in one float
  float rise;          // of H
  float t_per_s;
  float end;           // s where the interval ends
  float whole, part;   // s
  // Where that is:
  vec2 cell;
  vec2 fraction;
  float height;
};

const float RELIEVO_WALK_REBASE = 4096.0;  // whole · lead stays exact up to here
const float RELIEVO_WALK_NEVER = 1.0e30;   // s of an event that does not occur; times 1024 it is still finite
// A step goes this far beyond the border it aims at, so that it always gets across; what lies on the way is tested from
// the far side, where a point below the surface is a hit.
const float RELIEVO_WALK_MARGIN = 1.0e-6;
const float RELIEVO_WALK_FAR = 1.0e9;      // texels

// a · b as a sum of two floats (Dekker 1971), for |a|, |b| < 2^100.
void relievo_two_product(vec2 a, vec2 b, out vec2 product, out vec2 error) {
  precise vec2 ca = 4097.0 * a;
  precise vec2 a_high = ca - (ca - a);
  precise vec2 a_low = a - a_high;
  precise vec2 cb = 4097.0 * b;
  precise vec2 b_high = cb - (cb - b);
  precise vec2 b_low = b - b_high;
  precise vec2 p = a * b;
  precise vec2 e = ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low;
  product = p;
  error = e;
}

void relievo_walk_locate(inout Walk walk) {
  precise vec2 far = walk.whole * walk.lead;
  vec2 far_cell = floor(far);
  precise vec2 near = (far - far_cell) + (walk.whole * walk.rest + (walk.part * walk.slope + walk.base_fraction));
  vec2 near_cell = floor(near);
  precise vec2 fraction = near - near_cell;
  precise float height = walk.base_height + (walk.whole + walk.part) * walk.rise;
  walk.cell = walk.base_cell + (far_cell + near_cell);
  walk.fraction = fraction;
  walk.height = height;
}

// The copy of a cell in the first period, for whole numbers of any size; clamp and clip have no periods.
vec2 relievo_walk_first_period(vec2 cell, vec2 extent) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  vec2 period = extent;
#elif RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  vec2 period = 2.0 * extent;
#else
  return cell;
#endif
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT || RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  return vec2(relievo_modulo(int(cell.x), int(period.x)), relievo_modulo(int(cell.y), int(period.y)));
#endif
}

// Starts a walk at t = interval.enter. Returns false for places so far out that floats cannot tell cells apart.
bool relievo_walk_start(Ray ray, Interval interval, ivec2 extent, out Walk walk) {
  walk.extent = vec2(extent);
  vec2 start, start_error, way, way_error, move, move_error;
  relievo_two_product(clamp(ray.origin.xy, -RELIEVO_WALK_FAR, RELIEVO_WALK_FAR), walk.extent, start, start_error);
  relievo_two_product(clamp(ray.direction.xy, -1.0e15, 1.0e15), walk.extent, way, way_error);
  vec2 reach = abs(interval.enter * way);
  if (!(max(max(abs(start.x), abs(start.y)), max(reach.x, reach.y)) < RELIEVO_WALK_FAR)) return false;
  relievo_two_product(vec2(min(interval.enter, 1.0e20)), way, move, move_error);
  precise vec2 error = (start_error + (move_error + interval.enter * way_error)) - 0.5;
  vec2 start_cell = floor(start), move_cell = floor(move);
  precise vec2 rest = ((start - start_cell) + (move - move_cell)) + error;
  vec2 rest_cell = floor(rest);
  precise vec2 fraction = rest - rest_cell;
  walk.base_fraction = fraction;
  walk.base_cell = relievo_walk_first_period(start_cell, walk.extent) + relievo_walk_first_period(move_cell, walk.extent) +
                   rest_cell;
  walk.base_height = relievo_entry_point(ray, interval).z;
  walk.base_t = interval.enter;

  float speed = max(max(max(abs(way.x), abs(way.y)), abs(ray.direction.z)), 1.0e-30);
  precise vec2 slope = way / speed;
  vec2 back, back_error;
  relievo_two_product(slope, vec2(speed), back, back_error);
  precise vec2 slope_error = (((way - back) - back_error) + way_error) / speed;
  precise vec2 split = 4097.0 * slope;
  precise vec2 lead = split - (split - slope);
  precise vec2 small = (slope - lead) + slope_error;
  walk.lead = lead;
  walk.rest = small;
  walk.slope = slope;
  walk.rise = ray.direction.z / speed;
  walk.t_per_s = 1.0 / speed;
  walk.whole = 0.0;
  walk.part = 0.0;
  precise float end = (interval.exit - interval.enter) * speed;
  walk.end = end;
  relievo_walk_locate(walk);
  return true;
}

float relievo_walk_t(Walk walk) {
  precise float t = walk.base_t + (walk.whole + walk.part) * walk.t_per_s;
  return t;
}

// Moves on by `distance` in s. A walk that has come far starts anew where it is.
void relievo_walk_on(inout Walk walk, float distance) {
  precise float part = walk.part + distance;
  float units = floor(part);
  walk.whole += units;
  walk.part = part - units;
  relievo_walk_locate(walk);
  if (walk.whole >= RELIEVO_WALK_REBASE) {
    walk.base_t = relievo_walk_t(walk);
    walk.end -= walk.whole + walk.part;
    walk.base_cell = walk.cell;
    walk.base_fraction = walk.fraction;
    walk.base_height = walk.height;
    walk.whole = 0.0;
    walk.part = 0.0;
  }
}

// How far it still is to the end of the interval.
float relievo_walk_left(Walk walk) {
  precise float left = walk.end - (walk.whole + walk.part);
  return max(left, 0.0);
}

// The first hit within the walk's cell, no further than `reach` on; as a distance, or RELIEVO_WALK_NEVER.
float relievo_walk_solve(Walk walk, vec4 corners, float reach) {
  precise vec2 to = clamp(walk.fraction + reach * walk.slope, 0.0, 1.0);
  precise float to_height = walk.height + reach * walk.rise;
  float share = relievo_cell_hit(corners, vec3(walk.fraction, walk.height), vec3(to, to_height));
  return share <= 1.0 ? share * reach : RELIEVO_WALK_NEVER;
}

// The hit at `distance` on. Its place comes from the cell, since far out a float t tells places apart worse than the walk.
Hit relievo_walk_hit(Ray ray, Walk walk, float distance) {
  relievo_walk_on(walk, distance);
  Hit hit = relievo_hit_at(ray, RELIEVO_HIT, relievo_walk_t(walk));
  precise vec2 rough = hit.point.xy * walk.extent;
  precise vec2 off = (walk.cell + 0.5 - rough) + walk.fraction;
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  vec2 period = walk.extent;
#else
  vec2 period = 2.0 * walk.extent;  // of mirror; for clamp and clip it is more than what is off
#endif
  precise vec2 place = hit.point.xy + (off - period * floor(off / period + 0.5)) / walk.extent;
  hit.point = vec3(place, walk.height);
  return hit;
}

// Does the ray start below the surface? None does that starts on the lid, and only those that do not cost a fetch.
bool relievo_walk_starts_inside(Interval interval, Walk walk) {
  return interval.enter == 0.0 && walk.height < 1.0 &&
         relievo_cell_clearance(relievo_cell_corners_at(walk.cell, walk.extent), vec3(walk.fraction, walk.height)) < 0.0;
}
