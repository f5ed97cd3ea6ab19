// Parallax occlusion mapping (Tatarchuk 2006 §3.1): the height profile between two samples is taken for a line, so one
// chord intersection finishes the linear search. Step count: her Eq. 1, n = n_min + (N·V)(n_max - n_min), grows with N·V
// as printed; her text wants more steps at grazing angles, so N·V stands for its complement here.
#include "shaders/lib/search.glsl"

int parallax_occlusion_steps(float n_dot_v) {
  float grazing = 1.0 - clamp(n_dot_v, 0.0, 1.0);
  float count = mix(float(parallax_occlusion_min_steps), float(parallax_occlusion_max_steps), grazing);
  return max(int(ceil(count)), 1);
}

Hit parallax_occlusion_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  Bracket bracket;
  int steps = parallax_occlusion_steps(ray.n_dot_v);
  if (!relievo_linear_search(ray, interval, clearance, steps, bracket)) return relievo_end_of(ray, interval);
  return relievo_hit_at(ray, RELIEVO_HIT, relievo_false_position(bracket));
}
