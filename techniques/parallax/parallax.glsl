// Parallax mapping (survey §4.1.2): the height h(u, v) at the processed point is taken for constant, so the visible
// point is where the ray is at that height: (u', v') = (u, v) + h (Vx, Vy) / Vz.
#include "shaders/lib/interval.glsl"

Hit parallax_trace(Ray ray) {
  Interval interval;
  if (!relievo_interval(ray, interval)) return relievo_beside(ray, interval);
  if (interval.end_status != RELIEVO_HIT) return relievo_end_of(ray, interval);
  RELIEVO_COUNT_STEP();
  float height = relievo_height_at(relievo_point(ray, interval.exit).xy);
  precise float t = (height - ray.origin.z) / ray.direction.z;  // falls, for it reaches the base
  return relievo_hit_at(ray, RELIEVO_HIT, clamp(t, interval.enter, interval.exit));
}
