#include "shaders/lib/interval.glsl"

Hit flat_trace(Ray ray) {
  return relievo_hit_at(ray, RELIEVO_HIT, 0.0);
}
