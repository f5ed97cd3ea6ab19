// The true, possibly sheared and mirrored map between normalized tangent space and world space (survey Eq. 5 and 7).

struct TangentFrame {
  vec3 tangent, bitangent;
  vec3 normal;         // displacement of H = 0 to 1, along the triangle's normal on the side of the extrusion
  vec3 adjugate_u, adjugate_v, adjugate_h;  // rows of the adjugate
  float determinant;   // 0: degenerate, draw undisplaced
};

TangentFrame relievo_tangent_frame(vec3 tangent, vec3 bitangent, vec3 extrusion, float scale) {
  TangentFrame frame;
  vec3 face = cross(tangent, bitangent);
  float area = length(face);
  float side = dot(face, extrusion) < 0.0 ? -1.0 : 1.0;
  frame.tangent = tangent;
  frame.bitangent = bitangent;
  frame.normal = area > 0.0 ? face * (side / area * length(extrusion) * scale) : vec3(0.0);
  frame.adjugate_u = cross(bitangent, frame.normal);
  frame.adjugate_v = cross(frame.normal, tangent);
  frame.adjugate_h = face;
  frame.determinant = dot(tangent, frame.adjugate_u);
  return frame;
}

vec3 relievo_to_world(TangentFrame frame, vec3 offset) {
  return offset.x * frame.tangent + offset.y * frame.bitangent + offset.z * frame.normal;
}

// The view ray through `processed` (u, v, H) along `view` (world), from the lid at t = 0 to the base at t = 1.
// The adjugate instead of the inverse: a ray needs its direction up to scale only, and its sign from the determinant.
// Returns false where no such ray exists: a degenerate frame, or a view that does not descend.
bool relievo_view_ray(TangentFrame frame, vec3 processed, vec3 view, out Ray ray) {
  vec3 direction = sign(frame.determinant) *
                   vec3(dot(frame.adjugate_u, view), dot(frame.adjugate_v, view), dot(frame.adjugate_h, view));
  ray = Ray(vec3(0.0), vec3(0.0, 0.0, -1.0), 1.0, 1.0);
  if (!(direction.z < 0.0)) return false;
  vec2 slope = direction.xy / -direction.z;
  ray.direction = vec3(slope, -1.0);
  ray.origin = vec3(processed.xy - slope * (1.0 - processed.z), 1.0);
  return relievo_is_valid(ray);
}
