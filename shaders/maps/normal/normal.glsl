// The height map's gradient (dh/du, dh/dv), recovered from the baked unit normal.
vec2 relievo_normal_gradient(vec2 uv) {
  vec3 normal = textureLod(relievo_normal_map, uv, 0.0).xyz;
  return -normal.xy / (max(normal.z, 1.0e-20) * normal_scale);
}
