#include <numeric>
#include <random>
#include <utility>

#include "relievo/mesh.hpp"

namespace relievo {

namespace {

/// Not std::shuffle: that one's order differs between standard libraries.
std::vector<std::uint32_t> random_order(std::size_t count, std::mt19937_64& random) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  if (values.empty()) return;
  std::vector<T> moved(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) moved[i] = values[order[i]];
  values = std::move(moved);
}

}  // namespace

Mesh shuffle(const Mesh& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Mesh shuffled = mesh;
  const auto vertices = random_order(mesh.positions.size(), random);
  reorder(shuffled.positions, vertices);
  reorder(shuffled.normals, vertices);
  reorder(shuffled.uvs, vertices);
  std::vector<std::uint32_t> new_index(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) new_index[vertices[i]] = i;

  reorder(shuffled.triangles, random_order(mesh.triangles.size(), random));
  for (auto& triangle : shuffled.triangles) {
    const std::size_t first = random() % 3;
    const auto [a, b, c] = triangle;
    const std::array<std::uint32_t, 3> corners = {new_index[a], new_index[b], new_index[c]};
    triangle = {corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]};
  }
  return shuffled;
}

}  // namespace relievo
