// Shades the displaced mesh with the normals of the height map (survey Eq. 9).
#define RELIEVO_NORMAL_FROM_HEIGHT (vertex_normal_source == vertex_normal_source_height)
#include "shaders/lib/aov.glsl"

layout(location = 0) in vec3 vertex_position;
layout(location = 1) in vec3 vertex_extrusion;
layout(location = 2) in vec3 vertex_point;
layout(location = 3) flat in vec3 vertex_tangent;
layout(location = 4) flat in vec3 vertex_bitangent;

void main() {
  vec3 normal = relievo_mesostructure_normal(vertex_tangent, vertex_bitangent, vertex_extrusion, vertex_point.xy);
  Ray ray = Ray(vertex_point, vec3(0.0, 0.0, -1.0), 0.0, 1.0);
  relievo_write(ray, Hit(RELIEVO_HIT, 0.0, vertex_point), vertex_position, normal);
}
