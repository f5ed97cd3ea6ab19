// A ray as a walk over cells, with its position kept relative to the cell that it is in: at texel 10000 of a map the place
// within a cell is as exact as at texel 0, which float coordinates of the whole map are not.
//
// The walk's parameter s is scaled so that no coordinate moves by more than 1 (texels, or H) a unit, and is kept as a whole and
// a part. The whole times the leading 9 bits of the direction is exact up to 32768 texels; what remains is small, so
// nothing is lost in their sum. Only s changes in a search's loop: the place is made from it, never added up.
#include "cell.glsl"
#include "fold.glsl"
#include "interval.glsl"

struct Walk {
  vec2 extent;         // texels
  vec2 base_cell;      // at s = 0
  vec2 base_fraction;  // in [0, 1)
  float base_height;
  float base_height_rest;  // what base_height lacks of the ray's, so that walks that start anew do not drift
  float base_t;
  vec2 lead, rest;     // the direction in cells: lead has 9 bits
  vec2 slope;          // lead + rest, in one float
  float rise;          // of H
  float t_per_s;
  float end;           // s where the interval ends
  vec2 heading;        // each +1 or −1
  vec2 pace;           // s a cell
  vec2 behind_at_zero; // |this − fraction| is how much of the cell lies behind
  bool starts_within;  // the domain of a clip map: a ray may pass its corner by less than t tells
};

struct WalkPlace {
  vec2 cell;      // whole numbers
  vec2 fraction;  // within the cell, in [0, 1)
  float height;
};

const float RELIEVO_WALK_FAST = 1.0e30;  // texels a unit of t

// A step goes this far beyond the border it aims at; what lies on the way is tested from the far side, where a point below
// the surface is a hit.
const float RELIEVO_WALK_MARGIN = 1.0e-6;
// Where a cell ends, a hair beyond its border: a ray that comes to it slowly gets across in a step, or in a few far out.
const float RELIEVO_WALK_ACROSS = 1.0 + 1.0 / 8388608.0;
const float RELIEVO_WALK_NEVER = 1.0e30;  // s of an event that does not occur; times 1024 it is still finite
const float RELIEVO_WALK_FAR = 1.0e6;     // texels: cells are folded exactly a tenth further
const float RELIEVO_WALK_SAME = 128.0;    // cells solved as one, at most: one float tells the place of a hit in them

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

// The ray's origin in the first period of the endless surface; nothing is lost in the subtraction.
vec2 relievo_walk_first_period(vec2 uv) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  precise vec2 first = uv - floor(uv);
#elif RELIEVO_ADDRESS == RELIEVO_ADDRESS_MIRROR
  precise vec2 first = uv - 2.0 * floor(0.5 * uv);
#else
  vec2 first = uv;
#endif
  return first;
}

// How far it is from s = 0 to the base, which lies 0 away where the walk starts below.
float relievo_walk_to_base(Walk walk) {
  precise float s = max(walk.base_height + walk.base_height_rest, 0.0) / max(-walk.rise, 1.0 / RELIEVO_WALK_NEVER);
  return s;
}

// Whether floats of s tell where that is.
bool relievo_walk_falls(Walk walk) { return -walk.rise >= 1.0 / RELIEVO_WALK_NEVER; }

// Starts a walk at t = interval.enter, or exactly at the lid or the side where one of them is meant: from far away, one float t
// tells places apart worse than the walk. Returns false for places so far out that floats cannot tell cells apart, and for
// directions so long that their products overflow.
bool relievo_walk_start(Ray ray, Interval interval, ivec2 extent, out Walk walk) {
  walk.extent = vec2(extent);
  vec2 start, start_error, way, way_error, move, move_error, fall, fall_error;
  relievo_two_product(clamp(relievo_walk_first_period(ray.origin.xy), -RELIEVO_WALK_FAR, RELIEVO_WALK_FAR), walk.extent,
                      start, start_error);
  relievo_two_product(ray.direction.xy, walk.extent, way, way_error);
  relievo_two_product(vec2(min(interval.enter, 1.0e30)), way, move, move_error);
  relievo_two_product(vec2(min(interval.enter, 1.0e30)), ray.direction.zz, fall, fall_error);
  vec2 start_cell = floor(start), move_cell = floor(move);
  vec2 cell = start_cell + move_cell;
  precise vec2 within = (start - start_cell) + (move - move_cell);
  precise vec2 error = start_error + (move_error + interval.enter * way_error);
  // What t lacks: where lid and sides are one float t, the ray enters where it has come to the last of them.
  bool at_lid = relievo_enters_at_lid(ray, interval);
  bvec2 at_side = relievo_enters_at_side(ray, interval);
  precise float to_lid = ((1.0 - ray.origin.z) - fall.x) - fall_error.x;
  precise vec2 to_side = ((mix(vec2(0.0), walk.extent, lessThan(way, vec2(0.0))) - start) - move) - error;
  float lid = at_lid ? to_lid / ray.direction.z : -RELIEVO_WALK_NEVER;
  float side = max(at_side.x ? to_side.x / way.x : -RELIEVO_WALK_NEVER, at_side.y ? to_side.y / way.y : -RELIEVO_WALK_NEVER);
  float rest = at_lid || any(at_side) ? max(lid, side) : 0.0;
  precise vec2 near = within + ((error + rest * way) - 0.5);
  vec2 near_cell = floor(near);
  precise vec2 fraction = near - near_cell;
  precise float height = (ray.origin.z + fall.x) + (fall_error.x + rest * ray.direction.z);
  walk.base_fraction = fraction;
  walk.base_cell = cell + near_cell;
  walk.base_height = at_lid && lid >= side ? 1.0 : height;
  walk.base_height_rest = 0.0;
  walk.base_t = interval.enter;

  // A power of two, by which nothing is rounded.
  float speed = max(max(max(abs(way.x), abs(way.y)), abs(ray.direction.z)), 1.0e-30);
  int power = (floatBitsToInt(speed) + 0x007fffff) & 0x7f800000;
  float s_per_t = intBitsToFloat(power), t_per_s = intBitsToFloat(0x7f000000 - power);
  vec2 slope = way * t_per_s;
  precise vec2 split = 32769.0 * slope;
  precise vec2 lead = split - (split - slope);
  precise vec2 small = (slope - lead) + way_error * t_per_s;
  walk.lead = lead;
  walk.rest = small;
  walk.slope = slope;
  walk.rise = ray.direction.z * t_per_s;
  walk.t_per_s = t_per_s;
  // Far above the lid, enter and exit are two t that floats hardly tell apart; the base is where the walk has come down to it.
  precise float end = (interval.exit - interval.enter) * s_per_t;
  walk.end = interval.end_status == RELIEVO_HIT && relievo_walk_falls(walk) ? relievo_walk_to_base(walk) : end;
  walk.heading = mix(vec2(-1.0), vec2(1.0), greaterThanEqual(slope, vec2(0.0)));
  walk.behind_at_zero = mix(vec2(1.0), vec2(0.0), greaterThanEqual(slope, vec2(0.0)));
  precise vec2 pace = 1.0 / max(abs(slope), vec2(1.0 / RELIEVO_WALK_NEVER));
  walk.pace = pace;
  walk.starts_within = true;
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLIP
  // How far it is to the sides that the ray leaves by. The others, by which it came, decided where it starts.
  // Corners want it exact where it is almost 0: Knuth's sum of two.
  precise vec2 place = start + move;
  precise vec2 of_start = place - move;
  precise vec2 lost = (start - of_start) + (move - (place - of_start));
  precise vec2 from_first = place + (lost + (error + rest * way));
  precise vec2 to_last = (walk.extent - place) - (lost + (error + rest * way));
  vec2 to_leave = mix(to_last, from_first, lessThan(slope, vec2(0.0)));
  if (slope.x == 0.0) to_leave.x = RELIEVO_WALK_NEVER;
  if (slope.y == 0.0) to_leave.y = RELIEVO_WALK_NEVER;
  walk.starts_within = interval.enter == 0.0 || min(to_leave.x, to_leave.y) >= 0.0;
  if (interval.end_status == RELIEVO_OUTSIDE) {
    precise vec2 leave = max(to_leave, vec2(0.0)) / max(abs(slope), vec2(1.0 / RELIEVO_WALK_NEVER));
    walk.end = min(min(leave.x, leave.y), RELIEVO_WALK_NEVER);
  }
#endif
  vec2 reach = max(abs(start), abs(interval.enter * way));
  return max(reach.x, reach.y) < RELIEVO_WALK_FAR && speed < RELIEVO_WALK_FAST;
}

WalkPlace relievo_walk_place(Walk walk, vec2 s) {
  precise vec2 far = s.x * walk.lead;
  vec2 far_cell = floor(far);
  precise vec2 near = (far - far_cell) + (s.x * walk.rest + (s.y * walk.slope + walk.base_fraction));
  vec2 near_cell = floor(near);
  precise vec2 fraction = near - near_cell;
  precise float height = walk.base_height + (s.x + s.y) * walk.rise;
  return WalkPlace(walk.base_cell + (far_cell + near_cell), fraction, height);
}

float relievo_walk_t(Walk walk, vec2 s) {
  precise float t = walk.base_t + (s.x + s.y) * walk.t_per_s;
  return t;
}

// s after going on by `distance`.
vec2 relievo_walk_on(vec2 s, float distance) {
  precise float part = s.y + distance;
  float units = floor(part);
  return vec2(s.x + units, part - units);
}

// A walk that has come far starts anew where it is, with s = 0: before the next stretch, a map's width at most where the map
// repeats, takes s.x to where its products are no longer exact.
bool relievo_walk_is_far(vec2 s) { return s.x >= 16384.0; }

void relievo_walk_rebase_to(inout WalkPlace place, inout Walk walk, inout vec2 s) {
  // The height that one float a stretch would lose is carried on, or walks would drift: rise = lead + small, as above.
  precise float lead = intBitsToFloat(floatBitsToInt(walk.rise) & int(0xffff8000u));
  precise float small = s.x * (walk.rise - lead) + (s.y * walk.rise + walk.base_height_rest);
  precise float fall = s.x * lead;
  precise float sum = walk.base_height + fall;
  precise float of_fall = sum - walk.base_height;
  precise float lost = (walk.base_height - (sum - of_fall)) + (fall - of_fall);  // Knuth's sum of two
  precise float height = sum + (lost + small);
  precise float rest = (lost + small) - (height - sum);
  walk.base_t = relievo_walk_t(walk, s);
  walk.end -= s.x + s.y;
  walk.base_cell = relievo_fold_to_first_period(place.cell, walk.extent);
  walk.base_fraction = place.fraction;
  walk.base_height = height;
  walk.base_height_rest = rest;
  place = WalkPlace(walk.base_cell, walk.base_fraction, walk.base_height);
  s = vec2(0.0);
}

void relievo_walk_rebase(inout Walk walk, inout vec2 s) {
  WalkPlace place = relievo_walk_place(walk, s);
  relievo_walk_rebase_to(place, walk, s);
}

// How far it still is to the end of the interval.
float relievo_walk_left(Walk walk, vec2 s) {
  precise float left = walk.end - (s.x + s.y);
  return left;
}

// Cells that lie ahead along each axis and are one with this one: beyond the edge of a clamped map nothing changes along the
// axis, for ever or until the map begins. The last before the map is left alone: one float does not say to 1e-6 texel where a
// longer way ends.
vec2 relievo_walk_same_ahead(Walk walk, vec2 cell) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLAMP
  bvec2 forward = greaterThanEqual(walk.heading, vec2(0.0));
  vec2 before = -1.0 - cell, behind = cell - (walk.extent - 1.0);
  vec2 to_map = clamp(mix(behind, before, vec2(forward)) - 1.0, 0.0, RELIEVO_WALK_SAME);
  return mix(to_map, vec2(RELIEVO_WALK_SAME), greaterThanEqual(mix(before, behind, vec2(forward)), vec2(0.0)));
#else
  return vec2(0.0);
#endif
}

// How far it is to the border of the cell and of those that are one with it.
float relievo_walk_border(Walk walk, WalkPlace place) {
  precise vec2 own = RELIEVO_WALK_ACROSS - abs(walk.behind_at_zero - place.fraction);
  precise vec2 border = (relievo_walk_same_ahead(walk, place.cell) + own) * walk.pace;
  return min(border.x, border.y);
}

// The first hit within the cell and no further than `reach` on; as a distance, or RELIEVO_WALK_NEVER.
float relievo_walk_solve(Walk walk, WalkPlace place, vec4 corners, float reach) {
  precise vec2 to = clamp(place.fraction + reach * walk.slope, 0.0, 1.0);
  precise float to_height = place.height + reach * walk.rise;
  float share = relievo_cell_hit(corners, vec3(place.fraction, place.height), vec3(to, to_height));
  return share <= 1.0 ? share * reach : RELIEVO_WALK_NEVER;
}

// (u, v) at t, where the walk has come to `place`: far out a float t tells places apart worse than the walk. Within a tile for
// stages that ask for it; there whole tiles do not matter, so that cells beyond those that fold exactly are no harm.
vec2 relievo_walk_uv(Ray ray, Walk walk, WalkPlace place, float t) {
#if RELIEVO_HITS_WITHIN_TILE
  vec2 cell = place.cell - walk.extent * relievo_fold_periods(place.cell, walk.extent);
  precise vec2 uv = (cell + 0.5 + place.fraction) / walk.extent;
#else
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_REPEAT
  vec2 period = walk.extent;
#else
  vec2 period = 2.0 * walk.extent;  // of mirror; for clamp and clip it is more than what is off
#endif
  vec2 near = relievo_point(ray, t).xy;
  precise vec2 rough = near * walk.extent;
  precise vec2 off = (place.cell + 0.5 - rough) + place.fraction;
  precise vec2 uv = near + (off - period * floor(off / period + 0.5)) / walk.extent;
#endif
  return uv;
}

Hit relievo_walk_hit(Ray ray, Walk walk, vec2 s) {
  WalkPlace place = relievo_walk_place(walk, s);
  float t = relievo_walk_t(walk, s);
  return Hit(RELIEVO_HIT, t, vec3(relievo_walk_uv(ray, walk, place, t), place.height));
}
