// Shading shared by all drawing stages, so that their images differ by geometry alone.
#include "scene.glsl"

// The height map's gradient, from what the stage's axis `normal_source` says: the baked normals, or central differences
// of the height map itself, which are what the normals were baked from.
vec2 relievo_shading_gradient(vec2 uv) {
#if RELIEVO_NORMAL_FROM_HEIGHT
  vec2 extent = vec2(textureSize(relievo_height_map, 0));
  vec2 along_u = vec2(1.0 / extent.x, 0.0), along_v = vec2(0.0, 1.0 / extent.y);
  return 0.5 * extent * vec2(relievo_height_at(uv + along_u) - relievo_height_at(uv - along_u),
                             relievo_height_at(uv + along_v) - relievo_height_at(uv - along_v));
#else
  return relievo_normal_gradient(uv);
#endif
}

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
  vec2 slope = relievo_shading_gradient(uv) * (scene_displacement.x * extent);
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
