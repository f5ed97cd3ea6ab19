// Binary search (survey §4.2.2): entry above and exit below the surface are the first bracket; halve it.
#include "shaders/lib/search.glsl"

Hit binary_search_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  Bracket bracket;
  if (!relievo_whole_bracket(ray, interval, clearance, bracket)) return relievo_end_of(ray, interval);
  relievo_bisect(ray, binary_search_steps, bracket);
  return relievo_hit_at(ray, RELIEVO_HIT, bracket.below);
}
