// What every drawing stage knows of the scene; the twin in C++ is SceneBlock (job/render_job.cpp).
#include "ray.glsl"

const int RELIEVO_MAX_LIGHTS = 4;

layout(std140, set = 0, binding = 1) uniform Scene {
  mat4 scene_view_projection;
  vec4 scene_eye;           // xyz
  vec4 scene_displacement;  // scale, bias
  vec4 scene_albedo;        // rgb, ambient
  vec4 scene_specular;      // strength, shininess
  ivec4 scene_counts;       // lights
  vec4 scene_light_direction[RELIEVO_MAX_LIGHTS];  // towards the light, unit
  vec4 scene_light_color[RELIEVO_MAX_LIGHTS];
};

vec4 relievo_clip_position(vec3 world) { return scene_view_projection * vec4(world, 1.0); }

float relievo_depth(vec3 world) {
  vec4 clip = relievo_clip_position(world);
  return clamp(clip.z / clip.w, 0.0, 1.0);
}

float relievo_n_dot_v(vec3 normal, vec3 view) {
  float lengths = length(normal) * length(view);
  return lengths > 0.0 ? abs(dot(normal, view)) / lengths : 1.0;
}
