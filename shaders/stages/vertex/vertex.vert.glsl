// Survey §3.1: r(u, v) = p(u, v) + N (bias + scale h(u, v)).
#include "shaders/lib/scene.glsl"
#include "shaders/lib/vertex_input.glsl"

layout(location = 0) out vec3 vertex_position;
layout(location = 1) out vec3 vertex_extrusion;
layout(location = 2) out vec3 vertex_point;
layout(location = 3) flat out vec3 vertex_tangent;
layout(location = 4) flat out vec3 vertex_bitangent;

void main() {
  float height = relievo_height_at(in_uv);
  vertex_position = in_position + in_extrusion * (scene_displacement.y + scene_displacement.x * height);
  vertex_extrusion = in_extrusion;
  vertex_point = vec3(in_uv, height);
  vertex_tangent = in_tangent;
  vertex_bitangent = in_bitangent;
  gl_Position = relievo_clip_position(vertex_position);
}
