/// The reference picture, read backwards: from surface coordinates to pixels.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "measure/quantiles.hpp"
#include "relievo/measure.hpp"

namespace relievo {

namespace {

using glm::dvec2;
using glm::ivec2;

constexpr double seam = 0.25;           // of the texture, between neighbouring pixels
constexpr double own_pixel = 0.5;       // a pixel shows its surface as far as this around, pixels
constexpr double on_the_border = 1e-6;  // of a triangle: neighbours share their borders in spite of rounding

bool shows_surface(const Image& image, std::size_t pixel) {
  const float* p = &image.pixels[4 * pixel];
  return p[3] > 0 && std::isfinite(p[0]) && std::isfinite(p[1]);
}

dvec2 surface_at(const Image& image, std::size_t pixel) {
  return {image.pixels[4 * pixel], image.pixels[4 * pixel + 1]};
}

double cross(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

int modulo(int value, int n) {
  return (value % n + n) % n;
}

/// Modulo 1, in [0,1).
dvec2 in_tile(const dvec2& surface) {
  dvec2 result = glm::fract(surface);
  return {result.x < 1 ? result.x : 0, result.y < 1 ? result.y : 0};
}

/// From `a` to `b`, the short way round.
dvec2 step(const dvec2& a, const dvec2& b) {
  return b - a - glm::round(b - a);
}

double longest(const dvec2& v) {
  return std::max(std::abs(v.x), std::abs(v.y));
}

/// A pixel of the measured picture, the surface point that it shows, and its distance to that point's nearest place.
struct Feature {
  ivec2 pixel;
  dvec2 surface;  // modulo 1
  double offset;  // infinite: not found yet
};

/// How far a point that `pixel` shows nearly lies from it, by the smallest step of (u,v) to a neighbour; infinite
/// beyond the pixel itself. At outlines there is nothing else to go by: no three pixels are around the point.
double offset_within_pixel(const Image& reference, const ivec2& pixel, const dvec2& surface) {
  auto index = [&](const ivec2& p) {
    return static_cast<std::size_t>(p.y) * static_cast<std::size_t>(reference.width) + static_cast<std::size_t>(p.x);
  };
  const double none = std::numeric_limits<double>::infinity();
  dvec2 here = surface_at(reference, index(pixel));
  double smallest = none;
  for (const ivec2& way : {ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1)}) {
    ivec2 next = pixel + way;
    if (next.x < 0 || next.y < 0 || next.x >= reference.width || next.y >= reference.height) continue;
    if (shows_surface(reference, index(next)))
      smallest = std::min(smallest, longest(step(here, surface_at(reference, index(next)))));
  }
  double offset = longest(step(here, surface)) / smallest;
  return smallest < none && offset <= own_pixel ? offset : none;
}

/// Features by where they are on the texture: size² square cells, each a range of `features`.
class FeatureGrid {
 public:
  FeatureGrid(int size, const std::vector<Feature>& unordered)
      : size_(size), starts_(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_) + 1) {
    for (const Feature& f : unordered) ++starts_[cell_of(cell_at(f.surface)) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    features_.resize(unordered.size());
    std::vector<std::size_t> next = starts_;
    for (const Feature& f : unordered) features_[next[cell_of(cell_at(f.surface))]++] = f;
  }

  /// Calls `visit(feature, surface)` for every feature in cells that the box touches; `surface` is the feature's, in
  /// the tile of the texture that the box is in.
  template <class Visit>
  void visit(const dvec2& low, const dvec2& high, Visit visit) {
    ivec2 first = cell_at(low), last = cell_at(high);
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) {
        std::size_t cell = cell_of({x, y});
        dvec2 tile = glm::floor(dvec2(x, y) / static_cast<double>(size_));
        for (std::size_t i = starts_[cell]; i < starts_[cell + 1]; ++i)
          visit(features_[i], features_[i].surface + tile);
      }
    }
  }

  const std::vector<Feature>& features() const { return features_; }

 private:
  ivec2 cell_at(const dvec2& surface) const { return glm::floor(surface * static_cast<double>(size_)); }
  std::size_t cell_of(const ivec2& cell) const {
    return static_cast<std::size_t>(modulo(cell.y, size_)) * static_cast<std::size_t>(size_) +
           static_cast<std::size_t>(modulo(cell.x, size_));
  }

  int size_;
  std::vector<std::size_t> starts_;
  std::vector<Feature> features_;
};

/// The surface between three pixels of the reference: features on it are shown there.
void show_triangle(const Image& reference, const std::array<ivec2, 3>& pixels, FeatureGrid& grid) {
  std::array<dvec2, 3> surface;
  for (std::size_t i = 0; i < 3; ++i) {
    std::size_t pixel = static_cast<std::size_t>(pixels[i].y) * static_cast<std::size_t>(reference.width) +
                        static_cast<std::size_t>(pixels[i].x);
    if (!shows_surface(reference, pixel)) return;
    surface[i] = surface_at(reference, pixel);
  }
  dvec2 origin = in_tile(surface[0]), a = step(surface[0], surface[1]), b = step(surface[0], surface[2]);
  double area = cross(a, b);
  if (area == 0 || std::max({longest(a), longest(b), longest(b - a)}) > seam) return;
  dvec2 low = origin + glm::min(dvec2(0), glm::min(a, b)), high = origin + glm::max(dvec2(0), glm::max(a, b));
  grid.visit(low, high, [&](Feature& feature, const dvec2& point) {
    double s = cross(point - origin, b) / area, t = cross(a, point - origin) / area;
    if (std::min({s, t, 1 - s - t}) < -on_the_border) return;
    dvec2 place = dvec2(pixels[0]) + s * dvec2(pixels[1] - pixels[0]) + t * dvec2(pixels[2] - pixels[0]);
    feature.offset = std::min(feature.offset, glm::distance(place, dvec2(feature.pixel)));
  });
}

/// Cells about as large as what a pixel shows.
int grid_size(const Image& reference) {
  constexpr int least = 16, most = 2048;
  std::vector<double> steps;
  for (std::size_t i = 1; i < reference.pixels.size() / 4; ++i) {
    if (!shows_surface(reference, i - 1) || !shows_surface(reference, i)) continue;
    steps.push_back(longest(step(surface_at(reference, i - 1), surface_at(reference, i))));
  }
  if (steps.empty()) return least;
  return static_cast<int>(std::clamp(1 / std::max(quantiles(steps).p50, 1e-6), double{least}, double{most}));
}

}  // namespace

PixelOffsets pixel_offsets(const Image& reference, const Image& measured) {
  assert(reference.width == measured.width && reference.height == measured.height);
  assert(reference.channels == 4 && measured.channels == 4);
  PixelOffsets result;
  std::vector<double> offsets;
  std::vector<Feature> moved;
  for (std::size_t i = 0; i < measured.pixels.size() / 4; ++i) {
    if (!shows_surface(reference, i) || !shows_surface(measured, i)) continue;
    ++result.judged;
    dvec2 surface = surface_at(measured, i);
    if (surface == surface_at(reference, i)) {
      offsets.push_back(0);
      continue;
    }
    ivec2 pixel(static_cast<int>(i) % measured.width, static_cast<int>(i) / measured.width);
    moved.push_back({pixel, in_tile(surface), offset_within_pixel(reference, pixel, surface)});
  }
  FeatureGrid grid(grid_size(reference), moved);
  for (int y = 0; y + 1 < reference.height; ++y) {
    for (int x = 0; x + 1 < reference.width; ++x) {
      show_triangle(reference, {{{x, y}, {x + 1, y}, {x, y + 1}}}, grid);
      show_triangle(reference, {{{x + 1, y + 1}, {x, y + 1}, {x + 1, y}}}, grid);
    }
  }
  for (const Feature& feature : grid.features()) {
    if (std::isfinite(feature.offset)) {
      offsets.push_back(feature.offset);
    } else {
      ++result.lost;
    }
  }
  result.pixels = quantiles(offsets);
  return result;
}

}  // namespace relievo
