// Iterative parallax mapping (survey §4.2.1): uvh += (h(uv) - H) Nz V, from the processed point at the base, V of unit
// length towards the eye. Every guess lies on the ray, so its height H stands for it: dH = (h - H) Nz N·V.
#include "shaders/lib/interval.glsl"

Hit iterative_parallax_trace(Ray ray) {
  Interval interval;
  if (!relievo_interval(ray, interval)) return relievo_beside(ray, interval);
  if (interval.end_status != RELIEVO_HIT) return relievo_end_of(ray, interval);
  float t = interval.exit;
  for (int i = 0; i < iterative_parallax_steps; ++i) {
    RELIEVO_COUNT_STEP();
    vec3 point = relievo_point(ray, t);
    precise float rise = (relievo_height_at(point.xy) - point.z) * relievo_normal_z(point.xy) * ray.n_dot_v;
    precise float next = t + rise / ray.direction.z;  // falls, for it reaches the base
    t = clamp(next, interval.enter, interval.exit);
  }
  return relievo_hit_at(ray, RELIEVO_HIT, t);
}
