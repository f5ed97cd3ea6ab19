// Passes the base mesh through: the triangle lies at displacement 0.
#include "shaders/lib/scene.glsl"
#include "shaders/lib/vertex_input.glsl"

layout(location = 0) out vec3 vertex_position;
layout(location = 1) out vec3 vertex_extrusion;
layout(location = 2) out vec2 vertex_uv;
layout(location = 3) flat out vec3 vertex_tangent;
layout(location = 4) flat out vec3 vertex_bitangent;

void main() {
  vertex_position = in_position;
  vertex_extrusion = in_extrusion;
  vertex_uv = in_uv;
  vertex_tangent = in_tangent;
  vertex_bitangent = in_bitangent;
  gl_Position = relievo_clip_position(in_position);
}
