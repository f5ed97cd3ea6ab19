// Linear search (survey §4.3.1): equal steps from entry to exit; the first point that is not above the surface is the hit.
#include "shaders/lib/search.glsl"

Hit linear_search_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  Bracket bracket;
  if (!relievo_linear_search(ray, interval, clearance, linear_search_steps, bracket)) return relievo_end_of(ray, interval);
  return relievo_hit_at(ray, RELIEVO_HIT, bracket.below);
}
