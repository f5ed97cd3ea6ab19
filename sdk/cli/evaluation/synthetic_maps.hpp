/// Height maps made by the project: the shapes that break displacement techniques, and noise. The same on every
/// machine.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "relievo/height_map.hpp"

namespace relievo::synthetic {

/// A map whose texel (i, j) is height_of(i, j), brought into [0,1].
template <class HeightOf>
HeightMap make_map(int width, int height, HeightOf height_of, AddressMode address = AddressMode::repeat) {
  HeightMap map{width, height, {}, address};
  map.texels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) map.texels.push_back(std::clamp(static_cast<float>(height_of(i, j)), 0.0f, 1.0f));
  return map;
}

/// A well-mixed 64-bit number from another (SplitMix64, Steele, Lea and Flood 2014).
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Uniform numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(mix(seed)) {}
  /// In [0, 1).
  double uniform() { return static_cast<double>(mix(state_++) >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, count).
  int below(int count) { return static_cast<int>(uniform() * count); }

 private:
  std::uint64_t state_;
};

inline HeightMap constant_map(int width, int height, double value) {
  return make_map(width, height, [=](int, int) { return value; });
}

/// Rises along u from 0 to 1; with repeat it falls back over one cell.
inline HeightMap ramp_map(int width, int height) {
  return make_map(width, height, [=](int i, int) { return width > 1 ? i / double(width - 1) : 0.5; });
}

/// 0 but for one texel of height 1 in the middle.
inline HeightMap spike_map(int width, int height) {
  return make_map(width, height, [=](int i, int j) { return i == width / 2 && j == height / 2 ? 1.0 : 0.0; });
}

/// 0 but for one column of texels of height 1.
inline HeightMap wall_map(int width, int height) {
  return make_map(width, height, [=](int i, int) { return i == width / 2 ? 1.0 : 0.0; });
}

/// 0 and 1 alternate: every cell is a saddle with the greatest twist there is.
inline HeightMap checker_map(int width, int height) {
  return make_map(width, height, [](int i, int j) { return double((i + j) % 2); });
}

/// `steps` flat treads along u, each `width / steps` texels long.
inline HeightMap staircase_map(int width, int height, int steps = 8) {
  return make_map(width, height, [=](int i, int) { return double(i * steps / width) / std::max(steps - 1, 1); });
}

/// A square plateau at exactly 1 in the middle of a floor at exactly 0.
inline HeightMap plateau_map(int width, int height) {
  const auto in_middle = [](int i, int extent) { return 4 * i >= extent && 4 * i < 3 * extent; };
  return make_map(width, height, [=](int i, int j) { return in_middle(i, width) && in_middle(j, height) ? 1.0 : 0.0; });
}

/// Roofs whose ridges run along u (across = false) or along v (across = true), `period` texels apart.
inline HeightMap ridge_map(int width, int height, bool across, int period = 8) {
  return make_map(width, height, [=](int i, int j) {
    const int k = (across ? i : j) % period;
    return 1 - std::abs(2.0 * k / period - 1);
  });
}

inline double lattice_noise(int i, int j, std::uint64_t seed) {
  const std::uint64_t place = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32) |
                              static_cast<std::uint64_t>(static_cast<std::uint32_t>(j));
  return static_cast<double>(mix(place ^ mix(seed)) >> 11) * 0x1p-53;
}

/// Every texel independent and uniform.
inline HeightMap white_noise_map(int width, int height, std::uint64_t seed = 1) {
  return make_map(width, height, [=](int i, int j) { return lattice_noise(i, j, seed); });
}

/// 0 but for a quarter of the texels, whose heights are where floats and comparisons end.
inline HeightMap specks_map(int width, int height, std::uint64_t seed = 1) {
  constexpr std::array<double, 9> ends = {1, 1 - 6e-8, 0.5, 0.25, 3e-3, 1e-7, 1.2e-38, 1e-39, 1.4e-45};
  return make_map(width, height, [=](int i, int j) {
    if (lattice_noise(i, j, seed) > 0.25) return 0.0;
    return ends[static_cast<std::size_t>(lattice_noise(i, j, seed + 1) * ends.size()) % ends.size()];
  });
}

/// Value noise of period 1: `frequency` knots along each axis, with a smoothstep in between.
inline double value_noise(double u, double v, int frequency, std::uint64_t seed) {
  const double x = u * frequency, y = v * frequency;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const auto knot = [=](int a, int b) { return lattice_noise(a % frequency, b % frequency, seed); };
  const double a = ease(x - i), b = ease(y - j);
  return std::lerp(std::lerp(knot(i, j), knot(i + 1, j), a), std::lerp(knot(i, j + 1), knot(i + 1, j + 1), a), b);
}

/// Hills over hills, seamless with repeat; the octaves halve in size and height down to about a texel.
inline HeightMap smooth_noise_map(int width, int height, std::uint64_t seed = 1) {
  return make_map(width, height, [=](int i, int j) {
    const double u = (i + 0.5) / width, v = (j + 0.5) / height;
    double sum = 0, weight = 0.5;
    for (int frequency = 4; frequency <= std::max(4, std::max(width, height) / 4); frequency *= 2, weight /= 2)
      sum += weight * value_noise(u, v, frequency, seed + static_cast<std::uint64_t>(frequency));
    return sum;
  });
}

}  // namespace relievo::synthetic
