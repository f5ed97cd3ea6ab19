#include <map>
#include <tuple>
#include <utility>

#include "relievo/mesh.hpp"
#include "scene/vectors.hpp"

namespace relievo {

namespace {

/// Weighted corners of one point; the weights sum to `factor`.
struct Corner {
  std::uint32_t vertex = 0;
  int weight = 0;
};

class Subdivider {
 public:
  Subdivider(const Mesh& coarse, int factor)
      : coarse_(coarse), factor_(factor), weld_(weld_positions(coarse)), fine_(coarse) {
    fine_.triangles.clear();
    fine_.triangles.reserve(coarse.triangles.size() * static_cast<std::size_t>(factor) *
                            static_cast<std::size_t>(factor));
  }

  Mesh run() {
    for (const auto& triangle : coarse_.triangles) cut(triangle);
    return std::move(fine_);
  }

 private:
  /// Rows of points from corner a to the edge b–c: point (row, k) is a + row·(b−a)/factor + k·(c−b)/factor.
  void cut(const std::array<std::uint32_t, 3>& triangle) {
    std::vector<std::uint32_t> above = {triangle[0]};
    for (int row = 1; row <= factor_; ++row) {
      std::vector<std::uint32_t> points;
      for (int k = 0; k <= row; ++k)
        points.push_back(point({{{triangle[0], factor_ - row}, {triangle[1], row - k}, {triangle[2], k}}}));
      for (std::size_t k = 0; k < above.size(); ++k) {
        fine_.triangles.push_back({above[k], points[k], points[k + 1]});
        if (k + 1 < above.size()) fine_.triangles.push_back({above[k], points[k + 1], above[k + 1]});
      }
      above = std::move(points);
    }
  }

  std::uint32_t point(std::array<Corner, 3> used) {
    const auto rank = [&](const Corner& c) { return std::tuple(c.weight == 0, weld_[c.vertex], c.vertex); };
    // Both triangles at an edge sum in this order, so that they round to the same point. Unused corners come last.
    const auto order = [&](Corner& a, Corner& b) {
      if (rank(b) < rank(a)) std::swap(a, b);
    };
    order(used[0], used[1]);
    order(used[1], used[2]);
    order(used[0], used[1]);
    const std::size_t count = used[1].weight == 0 ? 1 : used[2].weight == 0 ? 2 : 3;
    if (count == 1) return used[0].vertex;
    if (count == 3) return add(used, count);
    const auto key = std::array{used[0].vertex, used[1].vertex, static_cast<std::uint32_t>(used[1].weight)};
    const auto [found, is_new] = edge_points_.try_emplace(key, 0);
    if (is_new) found->second = add(used, count);
    return found->second;
  }

  template <std::size_t N>
  void append(std::vector<std::array<float, N>>& to, const std::vector<std::array<float, N>>& from,
              const std::array<Corner, 3>& used, std::size_t count) {
    if (from.empty()) return;
    std::array<float, N> value;
    for (std::size_t axis = 0; axis < N; ++axis) {
      double sum = 0;
      for (std::size_t c = 0; c < count; ++c) sum += used[c].weight * static_cast<double>(from[used[c].vertex][axis]);
      value[axis] = static_cast<float>(sum / factor_);
    }
    to.push_back(value);
  }

  std::uint32_t add(const std::array<Corner, 3>& used, std::size_t count) {
    append(fine_.positions, coarse_.positions, used, count);
    append(fine_.normals, coarse_.normals, used, count);
    append(fine_.uvs, coarse_.uvs, used, count);
    return static_cast<std::uint32_t>(fine_.positions.size() - 1);
  }

  const Mesh& coarse_;
  int factor_;
  std::vector<std::uint32_t> weld_;
  Mesh fine_;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> edge_points_;
};

}  // namespace

Mesh subdivide(const Mesh& mesh, int factor) {
  return factor <= 1 ? mesh : Subdivider(mesh, factor).run();
}

}  // namespace relievo
