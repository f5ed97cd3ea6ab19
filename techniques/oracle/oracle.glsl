// Replays the exact hit of this pixel: status and t, computed on the CPU for the ray that this stage makes.
#include "shaders/lib/ray.glsl"

Hit oracle_trace(Ray ray) {
  vec2 hit = relievo_oracle_hits_at(ivec2(gl_FragCoord.xy));
  return relievo_hit_at(ray, int(hit.x), hit.y);
}
