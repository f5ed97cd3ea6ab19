// Passes the base mesh on; instance i of a triangle becomes the i-th tetrahedron of its prism.
#include "shaders/lib/vertex_input.glsl"

layout(location = 0) out vec3 base_position;
layout(location = 1) out vec3 base_extrusion;
layout(location = 2) out vec2 base_uv;
layout(location = 3) flat out vec3 base_tangent;
layout(location = 4) flat out vec3 base_bitangent;
layout(location = 5) flat out uint base_weld;
layout(location = 6) flat out int base_tetrahedron;

void main() {
  base_position = in_position;
  base_extrusion = in_extrusion;
  base_uv = in_uv;
  base_tangent = in_tangent;
  base_bitangent = in_bitangent;
  base_weld = in_weld;
  base_tetrahedron = gl_InstanceIndex;
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
