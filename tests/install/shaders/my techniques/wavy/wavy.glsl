#include "shaders/lib/interval.glsl"
#include "part.glsl"

Hit wavy_trace(Ray ray) {
  return relievo_hit_at(ray, RELIEVO_HIT, wavy_part());
}
