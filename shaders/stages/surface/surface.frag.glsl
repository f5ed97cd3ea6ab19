// Traces the view ray of a fragment in the tangent frame of its triangle (survey Eq. 10 and 11).
#define RELIEVO_NORMAL_FROM_HEIGHT (surface_normal_source == surface_normal_source_height)
#include "shaders/lib/address.glsl"
#include "shaders/lib/aov.glsl"
#include "shaders/lib/tangent_frame.glsl"

layout(location = 0) in vec3 vertex_position;
layout(location = 1) in vec3 vertex_extrusion;
layout(location = 2) in vec2 vertex_uv;
layout(location = 3) flat in vec3 vertex_tangent;
layout(location = 4) flat in vec3 vertex_bitangent;

void main() {
  vec3 view = vertex_position - scene_eye.xyz;
  TangentFrame frame = relievo_tangent_frame(vertex_tangent, vertex_bitangent, vertex_extrusion, scene_displacement.x);
  vec2 tile = relievo_tile(vertex_uv);
  vec3 processed = vec3(vertex_uv - tile, -scene_displacement.y / scene_displacement.x);
  Ray ray;
  Hit hit;
  vec3 position = vertex_position;
  if (relievo_view_ray(frame, processed, view, ray)) {
    ray.n_dot_v = relievo_n_dot_v(frame.normal, view);
    hit = relievo_sanitized(ray, relievo_view_trace(ray));
#if RELIEVO_AOV != RELIEVO_AOV_STATUS && RELIEVO_AOV < RELIEVO_AOV_RAY_ORIGIN
    if (hit.status == RELIEVO_MISS || hit.status == RELIEVO_OUTSIDE) discard;
#endif
    position += relievo_to_world(frame, hit.point - processed);
  } else {
    ray = Ray(vec3(vertex_uv - tile, 1.0), vec3(0.0, 0.0, -1.0), 1.0, 1.0);
    hit = Hit(RELIEVO_HIT, 1.0, vec3(vertex_uv - tile, 0.0));
  }
  vec3 normal = relievo_mesostructure_normal(vertex_tangent, vertex_bitangent, vertex_extrusion, hit.point.xy);
#if surface_depth_write == surface_depth_write_on
  gl_FragDepth = relievo_depth(position);
#endif
  relievo_write(ray, hit, position, normal);
}
