// Shading shared by all drawing stages, so that their images differ by geometry alone.
#include "scene.glsl"

// Survey Eq. 9: N + (N0 x B) dh/du + (T x N0) dh/dv, h the displacement in world units; N0 the unit extrusion direction.
// `mirrored` frames (T x B against N0) keep the side of N0.
vec3 relievo_mesostructure_normal(vec3 tangent, vec3 bitangent, vec3 extrusion, vec2 uv) {
  float extent = length(extrusion);
  vec3 unit = extent > 0.0 ? extrusion / extent : vec3(0.0, 0.0, 1.0);  // a frame without area extrudes nowhere
#if RELIEVO_AOV != RELIEVO_AOV_COLOR && RELIEVO_AOV != RELIEVO_AOV_NORMAL
  return unit;  // nobody looks at it: no normal map, no binding
#else
  float side = dot(cross(tangent, bitangent), unit);
  if (side == 0.0) return unit;
  vec2 slope = relievo_normal_gradient(uv) * (scene_displacement.x * extent);
  vec3 normal = abs(side) * unit + sign(side) * (cross(unit, bitangent) * slope.x + cross(tangent, unit) * slope.y);
  float size = length(normal);
  return size > 0.0 && relievo_is_finite(size) ? normal / size : unit;
#endif
}

vec3 relievo_shade(vec3 position, vec3 normal) {
  vec3 view = normalize(scene_eye.xyz - position);
  vec3 color = scene_albedo.rgb * scene_albedo.a;
  for (int i = 0; i < scene_counts.x; ++i) {
    vec3 light = scene_light_direction[i].xyz;
    float diffuse = max(dot(normal, light), 0.0);
    vec3 halfway = light + view;
    float halfway_length = length(halfway);
    float aligned = halfway_length > 0.0 ? max(dot(normal, halfway) / halfway_length, 0.0) : 0.0;
    float specular = diffuse > 0.0 ? scene_specular.x * pow(aligned, scene_specular.y) : 0.0;
    color += scene_light_color[i].rgb * (scene_albedo.rgb * diffuse + specular);
  }
  return pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2));
}
