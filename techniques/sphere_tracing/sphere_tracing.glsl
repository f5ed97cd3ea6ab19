// Sphere tracing (Donnelly 2005; survey §4.3.4): a step as long as the distance to the surface passes over nothing.
#include "shaders/lib/cone_march.glsl"

// Units of H, with the lid as high as the map's distances take it to be, per t.
float sphere_tracing_speed(Ray ray, ConeMarch march) {
  vec2 way = vec2(march.speed / distance_field_scale, ray.direction.z);
  float largest = max(abs(way.x), abs(way.y));
  precise vec2 scaled = way / largest;
  precise float size = largest * sqrt(scaled.x * scaled.x + scaled.y * scaled.y);
  return size;
}

Hit sphere_tracing_trace(Ray ray) {
  Interval interval;
  float clearance;
  Hit hit;
  if (relievo_begin(ray, interval, clearance, hit)) return hit;
  ConeMarch march = relievo_cone_march(ray, sphere_tracing_minimum_step);
  if (march.speed == 0.0) return relievo_vertical_hit(ray, interval, clearance);
  float speed = sphere_tracing_speed(ray, march);
  Bracket bracket = Bracket(interval.enter, interval.enter, clearance, 0.0);
  for (int i = 0; i < sphere_tracing_sphere_steps; ++i) {
    RELIEVO_COUNT_STEP();
    float reach = relievo_distance_field_at(relievo_point(ray, bracket.above));
    if (relievo_march_by(ray, interval, max(reach / speed, march.minimum_step), bracket)) {
      return relievo_hit_at(ray, RELIEVO_HIT, relievo_refine_by_chords(ray, sphere_tracing_chord_steps, bracket));
    }
    if (bracket.above >= interval.exit) return relievo_end_of(ray, interval);
  }
  return relievo_hit_at(ray, RELIEVO_EXHAUSTED, bracket.above);
}
