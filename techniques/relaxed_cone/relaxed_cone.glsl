// Relaxed cone stepping (Policarpo and Oliveira 2007; survey §4.4.3): the step that passes the surface encloses one crossing only.
#include "shaders/lib/cone_march.glsl"

Hit relaxed_cone_refined(Ray ray, Bracket bracket) {
#if relaxed_cone_finish == 1
  return relievo_hit_at(ray, RELIEVO_HIT, relievo_refine_by_chords(ray, relaxed_cone_binary_steps, bracket));
#else
  relievo_bisect(ray, relaxed_cone_binary_steps, bracket);
  return relievo_hit_at(ray, RELIEVO_HIT, bracket.below);
#endif
}

Hit relaxed_cone_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  ConeMarch march = relievo_cone_march(ray, relaxed_cone_minimum_step);
  if (march.speed == 0.0) return relievo_vertical_hit(ray, interval, clearance);
  Bracket bracket = Bracket(interval.enter, interval.enter, clearance, 0.0);
  for (int i = 0; i < relaxed_cone_cone_steps; ++i) {
    RELIEVO_COUNT_STEP();
    float ratio = relievo_relaxed_cone_ratio(relievo_point(ray, bracket.above).xy);
    float advance = relievo_cone_step(march, ray, ratio, bracket.above_clearance);
    if (relievo_march_by(ray, interval, advance, bracket)) return relaxed_cone_refined(ray, bracket);
    if (bracket.above >= interval.exit) return relievo_end_of(ray, interval);
  }
  return relievo_hit_at(ray, RELIEVO_EXHAUSTED, bracket.above);
}
