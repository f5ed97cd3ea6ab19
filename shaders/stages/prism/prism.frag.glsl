// Traces a view ray from where it enters a tetrahedron of the prism to this fragment, where it leaves.
//
// The distances to the four faces are linear, so along the view ray they change by (this fragment's - the eye's). Going
// back from the fragment by the share q of the way to the eye, face k is met at q = distance_k / change_k; the nearest is
// the entry. Texture coordinates are linear in the distances as well: no plane equation, no inverse.
#define RELIEVO_NORMAL_FROM_HEIGHT (prism_normal_source == prism_normal_source_height)
#include "shaders/lib/aov.glsl"

layout(location = 0) in vec3 prism_position;
layout(location = 1) in vec4 prism_distances;
layout(location = 2) flat in vec4 prism_eye_distances;
layout(location = 3) flat in vec3 prism_point_0;
layout(location = 4) flat in vec3 prism_point_1;
layout(location = 5) flat in vec3 prism_point_2;
layout(location = 6) flat in vec3 prism_point_3;
layout(location = 7) flat in vec3 prism_extrusion_0;
layout(location = 8) flat in vec3 prism_extrusion_1;
layout(location = 9) flat in vec3 prism_extrusion_2;
layout(location = 10) flat in vec3 prism_extrusion_3;
layout(location = 11) flat in vec3 prism_tangent;
layout(location = 12) flat in vec3 prism_bitangent;
layout(location = 13) flat in int prism_exit;

vec3 prism_blend(vec4 w, vec3 a, vec3 b, vec3 c, vec3 d) { return w.x * a + w.y * b + w.z * c + w.w * d; }

vec3 prism_extrusion(vec4 w) {
  return prism_blend(w, prism_extrusion_0, prism_extrusion_1, prism_extrusion_2, prism_extrusion_3);
}

vec3 prism_point(vec4 w) { return prism_blend(w, prism_point_0, prism_point_1, prism_point_2, prism_point_3); }

float prism_way_back(vec4 distances, vec4 change) {
  float q = 1.0;
  for (int k = 0; k < 4; ++k) {
    if (change[k] > 0.0) q = min(q, max(distances[k], 0.0) / change[k]);
  }
  return q;
}

// What a fragment shows: where it is met, in texture space and in the world.
struct PrismHit {
  Ray ray;
  Hit hit;
  vec3 position;
  vec3 extrusion;
};

// A shell without thickness: this fragment is the hit.
PrismHit prism_flat_hit() {
  Ray ray = Ray(prism_point(prism_distances), vec3(0.0, 0.0, -1.0), 0.0, 1.0);
  return PrismHit(ray, Hit(RELIEVO_HIT, 0.0, ray.origin), prism_position, prism_extrusion(prism_distances));
}

PrismHit prism_first_hit() {
  relievo_cell = prism_exit >> 1;
  vec4 change = prism_distances - prism_eye_distances;
  float back = prism_way_back(prism_distances, change);
  vec4 entry = prism_distances - back * change;
  vec3 view = prism_position - scene_eye.xyz;

  Ray ray;
  ray.origin = prism_point(entry);
  ray.origin.z = clamp(ray.origin.z, 0.0, 1.0);
  ray.direction = back * prism_point(change);
  // A ray that leaves through the base ends there, at H = 0 exactly, and not where rounding puts the fragment.
  ray.t_max = (prism_exit & 1) != 0 && ray.direction.z < 0.0 ? RELIEVO_NO_LIMIT : 1.0;
  ray.n_dot_v = relievo_n_dot_v(prism_extrusion(entry), view);

  Hit hit = Hit(RELIEVO_MISS, 0.0, ray.origin);
  if (relievo_is_valid(ray)) hit = relievo_sanitized(ray, relievo_view_trace(ray));
  // Starting below the surface is the wall between two heights of a seam, or rounding at a shared face: solid either way.
  float t = clamp(hit.t, 0.0, 1.0);
  vec3 position = scene_eye.xyz + (1.0 - back * (1.0 - t)) * view;
  return PrismHit(ray, hit, position, prism_extrusion(entry + t * back * change));
}

void main() {
  PrismHit seen;
  if (prism_exit < 0) {
    seen = prism_flat_hit();
  } else {
    seen = prism_first_hit();
  }
  if (seen.hit.status == RELIEVO_MISS || seen.hit.status == RELIEVO_OUTSIDE) discard;
  gl_FragDepth = relievo_depth(seen.position);
  vec3 normal = relievo_mesostructure_normal(prism_tangent, prism_bitangent, seen.extrusion, seen.hit.point.xy);
  relievo_write(seen.ray, seen.hit, seen.position, normal);
}
