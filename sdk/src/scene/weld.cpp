#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "relievo/mesh.hpp"
#include "scene/vectors.hpp"

namespace relievo {

namespace {

/// An integer that orders as the float does, −0 as +0; unlike <, it orders NaN too, so that sorting stays sound.
std::uint32_t ordered_bits(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value == 0 ? 0.0f : value);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

std::array<std::uint32_t, 3> position_key(const std::array<float, 3>& p) {
  return {ordered_bits(p[0]), ordered_bits(p[1]), ordered_bits(p[2])};
}

bool precedes(const glm::dvec3& a, const glm::dvec3& b) {
  return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
}

/// Directions gathered at one position.
using Directions = std::vector<glm::dvec3>;

/// Face normals at each corner, as long as the corner's angle.
void gather_faces(const Mesh& mesh, const std::vector<std::uint32_t>& ids, std::vector<Directions>& directions) {
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 corner = to_double(mesh.positions[triangle[k]]);
      const glm::dvec3 a = to_double(mesh.positions[triangle[(k + 1) % 3]]) - corner;
      const glm::dvec3 b = to_double(mesh.positions[triangle[(k + 2) % 3]]) - corner;
      const glm::dvec3 normal = glm::cross(a, b);
      const double length = glm::length(normal);
      if (!(length > 0)) continue;
      directions[ids[triangle[k]]].push_back(normal / length * std::atan2(length, glm::dot(a, b)));
    }
  }
}

/// The different unit normals given: a vertex that a file repeats for each of its triangles counts once.
void gather_given(const Mesh& mesh, const std::vector<std::uint32_t>& ids, std::vector<Directions>& directions) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const glm::dvec3 normal = to_double(mesh.normals[i]);
    const double length = glm::length(normal);
    if (length > 0 && std::isfinite(length)) directions[ids[i]].push_back(normal / length);
  }
  for (Directions& group : directions) {
    std::sort(group.begin(), group.end(), precedes);
    group.erase(std::unique(group.begin(), group.end()), group.end());
  }
}

std::array<float, 3> mean_direction(Directions& group) {
  std::sort(group.begin(), group.end(), precedes);  // one order of summing, whatever the order of the triangles
  const glm::dvec3 sum = std::accumulate(group.begin(), group.end(), glm::dvec3(0));
  const double length = glm::length(sum);
  constexpr double cancelled = 1e-9;
  return length > cancelled ? to_float(sum / length) : std::array<float, 3>{0, 0, 1};
}

}  // namespace

std::vector<std::uint32_t> weld_positions(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> keys(mesh.positions.size());
  std::transform(mesh.positions.begin(), mesh.positions.end(), keys.begin(), position_key);
  std::vector<std::array<std::uint32_t, 3>> sorted = keys;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::vector<std::uint32_t> ids(keys.size());
  std::transform(keys.begin(), keys.end(), ids.begin(), [&](const auto& key) {
    return static_cast<std::uint32_t>(std::lower_bound(sorted.begin(), sorted.end(), key) - sorted.begin());
  });
  return ids;
}

void weld_normals(Mesh& mesh) {
  const std::vector<std::uint32_t> ids = weld_positions(mesh);
  if (ids.empty()) return;
  std::vector<Directions> directions(*std::max_element(ids.begin(), ids.end()) + 1u);
  if (mesh.normals.size() == mesh.positions.size()) {
    gather_given(mesh, ids, directions);
  } else {
    gather_faces(mesh, ids, directions);
  }
  std::vector<std::array<float, 3>> means(directions.size());
  std::transform(directions.begin(), directions.end(), means.begin(), mean_direction);
  mesh.normals.resize(ids.size());
  std::transform(ids.begin(), ids.end(), mesh.normals.begin(), [&](std::uint32_t id) { return means[id]; });
}

}  // namespace relievo
