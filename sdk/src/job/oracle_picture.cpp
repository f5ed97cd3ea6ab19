#include "job/oracle_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "job/camera.hpp"
#include "job/mesh_buffers.hpp"
#include "relievo/oracle.hpp"

namespace relievo {

namespace {

using glm::dvec3;
using glm::dvec4;

constexpr int base_face = 3;  // of the tetrahedron a b c C: opposite its lid corner

glm::dvec3 to_dvec3(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

/// A tetrahedron of a prism as an affine map: distances λ(p) to its faces, and the texture point Σ λ_k point_k.
struct Tetrahedron {
  int cell = 0;
  bool has_base = false;
  std::array<dvec3, 4> positions, points;
  dvec4 eye;                                     // λ of the eye
  std::array<dvec3, 4> gradients;                // of λ
  int left = 0, right = 0, top = 0, bottom = 0;  // pixels that it may cover, inclusive

  dvec3 point(const dvec4& w) const { return w.x * points[0] + w.y * points[1] + w.z * points[2] + w.w * points[3]; }
};

/// Corner k of tetrahedron i, of the prism over a < b < c: which of a, b, c, and whether on the lid.
struct CornerOf {
  int vertex;
  int lid;
};
constexpr CornerOf corners_of[3][4] = {
    {{0, 0}, {1, 0}, {2, 0}, {2, 1}}, {{0, 0}, {1, 0}, {1, 1}, {2, 1}}, {{0, 0}, {0, 1}, {1, 1}, {2, 1}}};

bool set_distances(Tetrahedron& t, const dvec3& eye) {
  glm::dmat3 edges(t.positions[1] - t.positions[0], t.positions[2] - t.positions[0], t.positions[3] - t.positions[0]);
  if (glm::determinant(edges) == 0) return false;
  glm::dmat3 rows = glm::transpose(glm::inverse(edges));
  t.gradients = {-(rows[0] + rows[1] + rows[2]), rows[0], rows[1], rows[2]};
  dvec3 offset = eye - t.positions[0];
  t.eye = {1 + glm::dot(t.gradients[0], offset), glm::dot(rows[0], offset), glm::dot(rows[1], offset),
           glm::dot(rows[2], offset)};
  return std::isfinite(t.eye.x + t.eye.y + t.eye.z + t.eye.w);
}

/// The pixels whose centres the projection may cover; everything when a corner is behind the eye.
void set_bounds(Tetrahedron& t, const glm::dmat4& projection, const SceneImage& image) {
  t.right = image.width - 1;
  t.bottom = image.height - 1;
  glm::dvec2 low(1e30), high(-1e30);
  for (const dvec3& position : t.positions) {
    dvec4 clip = projection * dvec4(position, 1);
    if (clip.w <= 0) return;
    glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(image.width, image.height);
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
  auto clamp = [](double value, int most) {
    return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(most)));
  };
  t.left = std::max(0, clamp(std::floor(low.x), image.width));
  t.top = std::max(0, clamp(std::floor(low.y), image.height));
  t.right = std::min(t.right, clamp(std::ceil(high.x), image.width));
  t.bottom = std::min(t.bottom, clamp(std::ceil(high.y), image.height));
}

std::vector<Tetrahedron> make_tetrahedra(const Scene& scene, const Mesh& mesh) {
  MeshBuffers buffers = make_mesh_buffers(mesh, scene.displacement.units, 1);
  glm::dmat4 projection(view_projection(scene));
  std::vector<Tetrahedron> tetrahedra;
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    std::array<const MeshVertex*, 3> order;
    for (std::size_t i = 0; i < 3; ++i) order[i] = &buffers.vertices[buffers.indices[3 * triangle + i]];
    std::sort(order.begin(), order.end(), [](const MeshVertex* a, const MeshVertex* b) { return a->weld < b->weld; });
    for (int i = 0; i < 3; ++i) {
      Tetrahedron t;
      t.cell = static_cast<int>(3 * triangle) + i;
      t.has_base = i == 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const MeshVertex& v = *order[static_cast<std::size_t>(corners_of[i][k].vertex)];
        double lid = corners_of[i][k].lid;
        double displacement =
            static_cast<double>(scene.displacement.bias) + static_cast<double>(scene.displacement.scale) * lid;
        t.positions[k] = to_dvec3(v.position) + to_dvec3(v.extrusion) * displacement;
        t.points[k] = {v.uv[0], v.uv[1], lid};
      }
      if (!set_distances(t, to_dvec3(scene.camera.position))) continue;
      set_bounds(t, projection, scene.image);
      tetrahedra.push_back(t);
    }
  }
  return tetrahedra;
}

/// The part of a view ray (eye + s · view) inside a tetrahedron, as a ray in texture space from entry to exit.
struct Segment {
  std::size_t pixel = 0;
  int cell = 0;
  double enter = 0, leave = 0;  // s
  Ray ray;
};

std::optional<Segment> cross(const Tetrahedron& t, const dvec3& view) {
  Segment segment{0, t.cell, 0, std::numeric_limits<double>::infinity(), {}};
  int leaving_face = -1;
  dvec4 change;
  for (int k = 0; k < 4; ++k) {
    change[k] = glm::dot(t.gradients[static_cast<std::size_t>(k)], view);
    double s = -t.eye[k] / change[k];
    if (change[k] > 0) segment.enter = std::max(segment.enter, s);
    if (change[k] < 0 && s < segment.leave) {
      segment.leave = s;
      leaving_face = k;
    }
    if (change[k] == 0 && t.eye[k] < 0) return std::nullopt;
  }
  if (!(segment.enter < segment.leave) || !std::isfinite(segment.leave)) return std::nullopt;
  dvec3 origin = t.point(t.eye + segment.enter * change);
  dvec3 direction = t.point(change) * (segment.leave - segment.enter);
  bool falls_out = t.has_base && leaving_face == base_face && direction.z < 0;
  segment.ray = {origin.x,
                 origin.y,
                 std::clamp(origin.z, 0.0, 1.0),
                 direction.x,
                 direction.y,
                 direction.z,
                 falls_out ? std::numeric_limits<double>::infinity() : 1.0};
  return segment;
}

std::vector<Segment> segments_of_row(const std::vector<Tetrahedron>& tetrahedra, const Scene& scene,
                                     const glm::dmat4& unproject, int y) {
  std::vector<Segment> segments;
  dvec3 eye = to_dvec3(scene.camera.position);
  for (const Tetrahedron& t : tetrahedra) {
    if (y < t.top || y > t.bottom) continue;
    for (int x = t.left; x <= t.right; ++x) {
      dvec4 ndc(2 * (x + 0.5) / scene.image.width - 1, 2 * (y + 0.5) / scene.image.height - 1, 1, 1);
      dvec4 far = unproject * ndc;
      std::optional<Segment> segment = cross(t, dvec3(far) / far.w - eye);
      if (!segment) continue;
      segment->pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.image.width) + static_cast<std::size_t>(x);
      segments.push_back(*segment);
    }
  }
  return segments;
}

MapData empty_hits(int width, int height) {
  std::vector<float> none(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  return {"oracle_hits", width, height, 3, std::move(none), AddressMode::clamp};
}

void set_hit(MapData& map, std::size_t pixel, HitStatus status, double t, int cell) {
  map.texels.set(3 * pixel, static_cast<float>(status));
  map.texels.set(3 * pixel + 1, static_cast<float>(t));
  map.texels.set(3 * pixel + 2, static_cast<float>(cell));
}

}  // namespace

HeightMap height_map_of(const MapSet& maps) {
  const MapData& height = maps.at("height");
  return {height.width, height.height, height.texels.floats(), height.address};
}

MapData exact_surface_hits(const HeightMap& height, const Image& origins, const Image& directions) {
  std::vector<Ray> rays;
  std::size_t pixels = origins.pixels.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i) {
    const float *o = &origins.pixels[4 * i], *d = &directions.pixels[4 * i];
    rays.push_back({o[0], o[1], o[2], d[0], d[1], d[2], o[3] > 0 ? d[3] : 0.0});
  }
  MapData map = empty_hits(origins.width, origins.height);
  std::vector<Hit> hits = Oracle(height).trace(rays);
  for (std::size_t i = 0; i < pixels; ++i) set_hit(map, i, hits[i].status, hits[i].t, 0);
  return map;
}

MapData exact_prism_hits(const HeightMap& height, const Scene& scene, const Mesh& mesh) {
  Oracle oracle(height);
  std::vector<Tetrahedron> tetrahedra = make_tetrahedra(scene, mesh);
  glm::dmat4 unproject = glm::inverse(glm::dmat4(view_projection(scene)));
  MapData map = empty_hits(scene.image.width, scene.image.height);
  std::vector<double> nearest(map.texels.size() / 3, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < nearest.size(); ++i) set_hit(map, i, HitStatus::miss, 0, -1);
  for (int y = 0; y < scene.image.height; ++y) {
    std::vector<Segment> segments = segments_of_row(tetrahedra, scene, unproject, y);
    for (const Segment& segment : segments) {
      if (segment.enter >= nearest[segment.pixel]) continue;
      Hit hit = oracle.trace(segment.ray);
      if (hit.status != HitStatus::hit && hit.status != HitStatus::inside) continue;
      double s = segment.enter + std::min(hit.t, 1.0) * (segment.leave - segment.enter);
      if (s >= nearest[segment.pixel]) continue;
      nearest[segment.pixel] = s;
      set_hit(map, segment.pixel, hit.status, hit.t, segment.cell);
    }
  }
  return map;
}

}  // namespace relievo
