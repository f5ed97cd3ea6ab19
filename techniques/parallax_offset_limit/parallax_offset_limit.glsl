// Parallax mapping with offset limiting (survey §4.1.3): (u', v') = (u, v) + h (Vx, Vy) with V of unit length, which is
// parallax mapping's offset times Vz = N·V. On the ray that is the point at height h N·V.
#include "shaders/lib/interval.glsl"

Hit parallax_offset_limit_trace(Ray ray) {
  Interval interval;
  if (!relievo_interval(ray, interval)) return relievo_beside(ray, interval);
  if (interval.end_status != RELIEVO_HIT) return relievo_end_of(ray, interval);
  RELIEVO_COUNT_STEP();
  float height = relievo_height_at(relievo_point(ray, interval.exit).xy);
  precise float t = (height * ray.n_dot_v - ray.origin.z) / ray.direction.z;  // falls, for it reaches the base
  return relievo_hit_at(ray, RELIEVO_HIT, clamp(t, interval.enter, interval.exit));
}
