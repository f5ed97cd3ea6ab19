// Combined linear search and false position (survey §4.4.2; interval mapping).
#include "shaders/lib/search.glsl"

Hit linear_false_position_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  Bracket bracket;
  if (!relievo_linear_search(ray, interval, clearance, linear_false_position_linear_steps, bracket)) {
    return relievo_end_of(ray, interval);
  }
  return relievo_hit_at(ray, RELIEVO_HIT, relievo_refine_by_chords(ray, linear_false_position_chord_steps, bracket));
}
