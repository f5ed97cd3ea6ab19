// Cone stepping (Dummer 2006; survey §4.3.5): a step leads to the border of the cone on the texel below.
#include "shaders/lib/cone_march.glsl"

Hit cone_stepping_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  ConeMarch march = relievo_cone_march(ray, cone_stepping_minimum_step);
  if (march.speed == 0.0) return relievo_vertical_hit(ray, interval, clearance);
  Bracket bracket = Bracket(interval.enter, interval.enter, clearance, 0.0);
  for (int i = 0; i < cone_stepping_cone_steps; ++i) {
    RELIEVO_COUNT_STEP();
    float ratio = relievo_cone_ratio(relievo_point(ray, bracket.above).xy);
    float advance = relievo_cone_step(march, ray, ratio, bracket.above_clearance);
    if (relievo_march_by(ray, interval, advance, bracket)) {
      return relievo_hit_at(ray, RELIEVO_HIT, relievo_refine_by_chords(ray, cone_stepping_chord_steps, bracket));
    }
    if (bracket.above >= interval.exit) return relievo_end_of(ray, interval);
  }
  return relievo_hit_at(ray, RELIEVO_EXHAUSTED, bracket.above);
}
