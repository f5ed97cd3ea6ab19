// Bump mapping (survey §4.1.1): the visible point is the processed point (u, v, 0), whatever the height map says.
#include "shaders/lib/interval.glsl"

Hit bump_trace(Ray ray) {
  Interval interval;
  if (!relievo_interval(ray, interval)) return relievo_beside(ray, interval);
  return relievo_end_of(ray, interval);
}
