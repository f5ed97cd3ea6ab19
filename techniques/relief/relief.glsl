// Relief mapping (survey §4.4.1): linear search for a bracket, then binary search (§4.2.2) within it.
#include "shaders/lib/search.glsl"

Hit relief_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  Bracket bracket;
  if (!relievo_linear_search(ray, interval, clearance, relief_linear_steps, bracket)) return relievo_end_of(ray, interval);
  relievo_bisect(ray, relief_binary_steps, bracket);
  return relievo_hit_at(ray, RELIEVO_HIT, bracket.below);
}
