// Extrudes a triangle along its vertex normals and emits one of the three tetrahedra of the prism (Hirche et al. 2004).
//
// One ordering rule: corners a < b < c by weld id, base corners a b c and lid corners A B C give the tetrahedra
//   a b c C,  a b B C,  a A B C.
// Every side is cut along the diagonal from its smaller base corner to its larger lid corner, so neighbours agree.
//
// Only faces that look away from the eye are emitted: each ray leaves a tetrahedron through exactly one of them, also
// when the eye is inside. A fragment finds its entry from the distances to the four faces (see prism.frag.glsl).
#include "shaders/lib/address.glsl"
#include "shaders/lib/scene.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 12) out;

layout(location = 0) in vec3 base_position[];
layout(location = 1) in vec3 base_extrusion[];
layout(location = 2) in vec2 base_uv[];
layout(location = 3) flat in vec3 base_tangent[];
layout(location = 4) flat in vec3 base_bitangent[];
layout(location = 5) flat in uint base_weld[];
layout(location = 6) flat in int base_tetrahedron[];

layout(location = 0) out vec3 prism_position;
layout(location = 1) out vec4 prism_distances;          // to the four faces, in heights of the tetrahedron
layout(location = 2) flat out vec4 prism_eye_distances;  // of the eye
layout(location = 3) flat out vec3 prism_point_0;        // (u, v, H) of the four corners
layout(location = 4) flat out vec3 prism_point_1;
layout(location = 5) flat out vec3 prism_point_2;
layout(location = 6) flat out vec3 prism_point_3;
layout(location = 7) flat out vec3 prism_extrusion_0;
layout(location = 8) flat out vec3 prism_extrusion_1;
layout(location = 9) flat out vec3 prism_extrusion_2;
layout(location = 10) flat out vec3 prism_extrusion_3;
layout(location = 11) flat out vec3 prism_tangent;
layout(location = 12) flat out vec3 prism_bitangent;
layout(location = 13) flat out int prism_exit;           // 2 · cell + 1 if the ray leaves by the base; or prism_flat

const int prism_flat = -1;

struct Corner {
  vec3 position;
  vec3 point;
  vec3 extrusion;
};

Corner prism_corner(int vertex, float lid) {
  float displacement = scene_displacement.y + scene_displacement.x * lid;
  return Corner(base_position[vertex] + base_extrusion[vertex] * displacement, vec3(base_uv[vertex], lid),
                base_extrusion[vertex]);
}

float prism_volume(vec3 a, vec3 b, vec3 c) { return dot(a, cross(b, c)); }

// Distances of `eye` from the four faces: its barycentric coordinates. Returns false for a tetrahedron without volume.
bool prism_eye(vec3 eye, Corner corners[4], out vec4 distances) {
  vec3 b = corners[1].position - corners[0].position;
  vec3 c = corners[2].position - corners[0].position;
  vec3 d = corners[3].position - corners[0].position;
  vec3 e = eye - corners[0].position;
  float volume = prism_volume(b, c, d);
  distances = vec4(0.0);
  if (volume == 0.0) return false;
  distances.yzw = vec3(prism_volume(e, c, d), prism_volume(b, e, d), prism_volume(b, c, e)) / volume;
  distances.x = prism_volume(b - e, c - e, d - e) / volume;
  return relievo_is_finite(distances);
}

void prism_emit(Corner corners[4], int vertex, vec4 eye_distances, vec2 tile, int leaves_by_base) {
  prism_position = corners[vertex].position;
  prism_distances = vec4(vertex == 0, vertex == 1, vertex == 2, vertex == 3);
  prism_eye_distances = eye_distances;
  prism_point_0 = corners[0].point - vec3(tile, 0.0);
  prism_point_1 = corners[1].point - vec3(tile, 0.0);
  prism_point_2 = corners[2].point - vec3(tile, 0.0);
  prism_point_3 = corners[3].point - vec3(tile, 0.0);
  prism_extrusion_0 = corners[0].extrusion;
  prism_extrusion_1 = corners[1].extrusion;
  prism_extrusion_2 = corners[2].extrusion;
  prism_extrusion_3 = corners[3].extrusion;
  prism_tangent = base_tangent[0];
  prism_bitangent = base_bitangent[0];
  int cell = 3 * gl_PrimitiveIDIn + base_tetrahedron[0];
  prism_exit = leaves_by_base == prism_flat ? prism_flat : 2 * cell + leaves_by_base;
  gl_Position = relievo_clip_position(corners[vertex].position);
  EmitVertex();
}

ivec3 prism_order() {
  ivec3 o = ivec3(0, 1, 2);
  if (base_weld[o.x] > base_weld[o.y]) o = o.yxz;
  if (base_weld[o.y] > base_weld[o.z]) o = o.xzy;
  if (base_weld[o.x] > base_weld[o.y]) o = o.yxz;
  return o;
}

// A shell without thickness has no tetrahedra: the triangle itself is drawn, at its bias.
void prism_emit_flat(Corner corners[4]) {
  for (int vertex = 0; vertex < 3; ++vertex) prism_emit(corners, vertex, vec4(0.0), vec2(0.0), prism_flat);
  EndPrimitive();
}

void main() {
  ivec3 o = prism_order();
  int tetrahedron = base_tetrahedron[0];
  Corner corners[4];
  corners[0] = prism_corner(o.x, 0.0);
  if (tetrahedron == 2) corners[1] = prism_corner(o.x, 1.0); else corners[1] = prism_corner(o.y, 0.0);
  if (tetrahedron == 0) corners[2] = prism_corner(o.z, 0.0); else corners[2] = prism_corner(o.y, 1.0);
  corners[3] = prism_corner(o.z, 1.0);
  if (scene_displacement.x == 0.0) {
    if (tetrahedron == 0) prism_emit_flat(corners);
    return;
  }
  vec4 eye_distances;
  if (!prism_eye(scene_eye.xyz, corners, eye_distances)) return;
  vec2 tile = relievo_tile(base_uv[o.x]);
  for (int face = 0; face < 4; ++face) {
    if (!(eye_distances[face] > 0.0)) continue;
    int leaves_by_base = tetrahedron == 0 && face == 3 ? 1 : 0;
    prism_emit(corners, face == 0 ? 1 : 0, eye_distances, tile, leaves_by_base);
    prism_emit(corners, face <= 1 ? 2 : 1, eye_distances, tile, leaves_by_base);
    prism_emit(corners, face <= 2 ? 3 : 2, eye_distances, tile, leaves_by_base);
    EndPrimitive();
  }
}
