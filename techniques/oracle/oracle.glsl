// Replays the exact hit of this pixel: status and t, computed on the CPU for the cell of the mesh that is hit.
#include "shaders/lib/ray.glsl"

Hit oracle_trace(Ray ray) {
  vec3 hit = relievo_oracle_hits_at(ivec2(gl_FragCoord.xy));
  if (int(hit.z) != relievo_cell) return relievo_hit_at(ray, RELIEVO_MISS, 0.0);
  return relievo_hit_at(ray, int(hit.x), hit.y);
}
