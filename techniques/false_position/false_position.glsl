// False position (survey §4.2.3, there called secant): the chord between the ends of the bracket meets the ray; that point
// replaces the end of its own side.
#include "shaders/lib/search.glsl"

Hit false_position_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  Bracket bracket;
  if (!relievo_whole_bracket(ray, interval, clearance, bracket)) return relievo_end_of(ray, interval);
  return relievo_hit_at(ray, RELIEVO_HIT, relievo_refine_by_chords(ray, false_position_steps, bracket));
}
