#include "report/synthetic.hpp"

#include <cmath>
#include <cstdint>
#include <functional>

namespace relievo::cli {

namespace {

constexpr double two_pi = 6.28318530717958647692;

/// A number in [0,1) for a texel, the same on every machine (SplitMix64, Steele, Lea and Flood 2014).
double random_at(int i, int j) {
  std::uint64_t x = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32) | static_cast<std::uint32_t>(j);
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

/// Waves over waves.
double hills(double u, double v) {
  double sum = std::sin(two_pi * (u + 0.3)) * std::cos(two_pi * (v + 0.1)) + 0.5 * std::sin(two_pi * (3 * u + 2 * v)) +
               0.25 * std::cos(two_pi * (5 * u - 7 * v)) + 0.125 * std::sin(two_pi * (11 * u + 13 * v));
  return 0.5 + sum / 3.75;
}

double terraces(double u, double v) {
  constexpr double treads = 8;
  return std::floor(hills(u, v) * treads * 0.999) / (treads - 1);
}

HeightMap make_map(int size, const std::function<double(int, int)>& height_of) {
  HeightMap map{size, size, {}, AddressMode::repeat};
  map.texels.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) map.texels.push_back(static_cast<float>(height_of(i, j)));
  return map;
}

}  // namespace

std::vector<NamedMap> make_synthetic_maps(int size) {
  auto at = [size](double (*shape)(double, double)) {
    return make_map(size, [=](int i, int j) { return shape((i + 0.5) / size, (j + 0.5) / size); });
  };
  constexpr int spike_apart = 16, ridge_apart = 32, square = 16;
  return {
      {"terraces", at(terraces)},
      {"spikes", make_map(size, [](int i, int j) { return i % spike_apart == 5 && j % spike_apart == 9 ? 1.0 : 0.0; })},
      {"ridges", make_map(size, [](int i, int) { return i % ridge_apart == 0 ? 1.0 : 0.1; })},
      {"checkerboard", make_map(size, [](int i, int j) { return (i / square + j / square) % 2 ? 1.0 : 0.0; })},
      {"noise", make_map(size, random_at)},
      {"hills", at(hills)}};
}

}  // namespace relievo::cli
