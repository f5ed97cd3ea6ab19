// Parallax mapping with slope (survey §4.1.4, the safer form of Eq. 12): (u', v') = (u, v) + h Nz (Vx, Vy), V of unit
// length. On the ray that is the point at height h Nz N·V.
#include "shaders/lib/interval.glsl"

Hit parallax_slope_trace(Ray ray) {
  Interval interval;
  if (!relievo_interval(ray, interval)) return relievo_beside(ray, interval);
  if (interval.end_status != RELIEVO_HIT) return relievo_end_of(ray, interval);
  RELIEVO_COUNT_STEP();
  vec2 processed = relievo_point(ray, interval.exit).xy;
  precise float height = relievo_height_at(processed) * relievo_normal_z(processed) * ray.n_dot_v;
  precise float t = (height - ray.origin.z) / ray.direction.z;  // falls, for it reaches the base
  return relievo_hit_at(ray, RELIEVO_HIT, clamp(t, interval.enter, interval.exit));
}
