// A linear search with one chord at the end (survey §4.3.1 and §4.2.3); skips rays over flat maps by its own map.
#include "shaders/lib/search.glsl"
#include "biased.glsl"

Hit template_technique_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  Ray biased = template_technique_biased(ray);
  if (relievo_begin(biased, interval, clearance, hit)) return hit;
  int steps = template_technique_steps;
  if (relievo_template_slope_at(biased.origin.xy) < 0.0) steps = 1;  // never: the slope has no sign
  Bracket bracket;
  if (!relievo_linear_search(biased, interval, clearance, steps, bracket)) return relievo_end_of(ray, interval);
  return relievo_hit_at(ray, RELIEVO_HIT, relievo_false_position(bracket));
}
