#include "shaders/lib/ray.glsl"

// The height map's gradient (dh/du, dh/dv), recovered from the baked unit normal.
vec2 relievo_normal_gradient(vec2 uv) {
  vec3 normal = textureLod(relievo_normal_map, uv, 0.0).xyz;
  return -normal.xy / (max(normal.z, 1.0e-20) * normal_scale);
}

// The rise of the unit normal: 1 on level ground. What techniques read is counted, unlike the gradient, which shades.
float relievo_normal_z(vec2 uv) {
  RELIEVO_COUNT_FETCHES(1);
  return clamp(textureLod(relievo_normal_map, uv, 0.0).z, 0.0, 1.0);
}
