// The part of a ray on which a hit is possible: between lid and base, and within the domain of a clip map.
#include "ray.glsl"

struct Interval {
  float enter;
  float exit;
  int end_status;  // what it means to reach `exit` without a hit: HIT at the base (there H = 0 <= h), MISS, OUTSIDE, EXHAUSTED
};

// Longest way in texture widths that a search covers when neither lid nor base nor t_max ends the ray.
const float RELIEVO_MAX_TRAVEL = 1024.0;

// Quotients of one value differ by less, relative to it. In ulp, 2^-23: 2.5 of each division, at most 1 of its numerator, and 1
// where this is used.
const float RELIEVO_SAME_TIME = 1.1e-6;

// Whether the later of two times may be the same as an earlier one, as far as their quotients tell.
bool relievo_is_same_time(float earlier, float later) {
  precise float latest = earlier * (1.0 + RELIEVO_SAME_TIME);
  return later <= latest;
}

// t where a coordinate that changes comes to [0, 1].
float relievo_side(float origin, float direction) {
  precise float side = ((direction < 0.0 ? 1.0 : 0.0) - origin) / direction;
  return side;
}

// Narrows the interval to the t where one coordinate lies in [0, 1]. No division by zero: a coordinate that does not
// change is either within for all t or for none.
void relievo_clip_axis(float origin, float direction, inout Interval interval) {
  if (direction == 0.0) {
    if (origin < 0.0 || origin > 1.0) interval = Interval(1.0, 0.0, RELIEVO_OUTSIDE);
    return;
  }
  interval.enter = max(interval.enter, relievo_side(origin, direction));
  precise float leave = ((direction < 0.0 ? 0.0 : 1.0) - origin) / direction;
  if (leave < interval.exit) {
    interval.exit = leave;
    interval.end_status = RELIEVO_OUTSIDE;
  }
}

// t where a ray from above comes down to the lid.
float relievo_lid(Ray ray) {
  precise float lid = (1.0 - ray.origin.z) / ray.direction.z;
  return lid;
}

// Returns false when the ray meets neither; interval.end_status then says why.
bool relievo_interval(Ray ray, out Interval interval) {
  interval = Interval(0.0, ray.t_max, RELIEVO_MISS);
  float height = ray.origin.z;
  float fall = ray.direction.z;
  if (height > 1.0) {
    if (fall >= 0.0) return false;
    interval.enter = relievo_lid(ray);
    if (!(interval.enter < RELIEVO_NO_LIMIT)) return false;  // further than floats go
  }
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLIP
  relievo_clip_axis(ray.origin.x, ray.direction.x, interval);
  relievo_clip_axis(ray.origin.y, ray.direction.y, interval);
  if (interval.enter > interval.exit) {
    // Near a corner of the domain two t may be one, rounded twice: an exact walk finds out whether it is met.
    if (interval.end_status != RELIEVO_OUTSIDE || !relievo_is_same_time(interval.exit, interval.enter)) return false;
    interval.exit = interval.enter;
  }
#endif
  if (fall < 0.0) {
    // A ray that enters a clip map's domain below the base meets its side there.
    precise float base = max(-height / fall, interval.enter);
    if (base <= interval.exit) {
      interval.exit = base;
      interval.end_status = RELIEVO_HIT;
    }
  } else if (fall > 0.0) {
    precise float lid = max((1.0 - height) / fall, 0.0);
    if (lid < interval.exit) {
      interval.exit = lid;
      interval.end_status = RELIEVO_MISS;
    }
  }
  float speed = max(abs(ray.direction.x), abs(ray.direction.y));
  if ((interval.exit - interval.enter) * speed > RELIEVO_MAX_TRAVEL) {
    interval.exit = interval.enter + RELIEVO_MAX_TRAVEL / speed;
    interval.end_status = RELIEVO_EXHAUSTED;
  } else if (interval.exit == RELIEVO_NO_LIMIT) {
    interval.exit = interval.enter;  // at rest above one point for ever: the entry decides
  }
  return interval.enter <= interval.exit;
}

bool relievo_enters_at_lid(Ray ray, Interval interval) {
  return ray.origin.z > 1.0 && relievo_is_same_time(relievo_lid(ray), interval.enter);
}

// For each axis, whether it is there that the ray comes into the domain of a clip map.
bvec2 relievo_enters_at_side(Ray ray, Interval interval) {
#if RELIEVO_ADDRESS == RELIEVO_ADDRESS_CLIP
  vec2 side = vec2(relievo_side(ray.origin.x, ray.direction.x), relievo_side(ray.origin.y, ray.direction.y));
  bvec2 changes = notEqual(ray.direction.xy, vec2(0.0));
  return bvec2(changes.x && interval.enter > 0.0 && relievo_is_same_time(side.x, interval.enter),
               changes.y && interval.enter > 0.0 && relievo_is_same_time(side.y, interval.enter));
#else
  return bvec2(false);
#endif
}

// The point at interval.enter, with H exact where that is the lid: a plateau at 1 is then touched, not missed by rounding.
vec3 relievo_entry_point(Ray ray, Interval interval) {
  vec3 point = relievo_point(ray, interval.enter);
  if (ray.origin.z > 1.0) point.z = relievo_enters_at_lid(ray, interval) ? 1.0 : min(point.z, 1.0);
  return point;
}

// Of a ray without an interval: it never comes to the domain of a clip map, or not to the slab.
Hit relievo_beside(Ray ray, Interval interval) {
  return relievo_hit_at(ray, interval.end_status == RELIEVO_OUTSIDE ? RELIEVO_OUTSIDE : RELIEVO_MISS, 0.0);
}

Hit relievo_end_of(Ray ray, Interval interval) { return relievo_hit_at(ray, interval.end_status, interval.exit); }
