#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "relievo/measure.hpp"
#include "unit/flip_reference.hpp"

namespace relievo {
namespace {

using Pixels = std::vector<std::uint8_t>;
using Rgb = std::array<int, 3>;

Pixels make(int width, int height, const std::function<Rgb(int, int)>& color) {
  Pixels pixels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c : color(x, y)) pixels.push_back(static_cast<std::uint8_t>(std::clamp(c, 0, 255)));
      pixels.push_back(255);
    }
  }
  return pixels;
}

Pixels flat(const Rgb& color) {
  return make(24, 24, [&](int, int) { return color; });
}

Pixels noise(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  return make(width, height, [&](int, int) {
    return Rgb{static_cast<int>(random() % 256), static_cast<int>(random() % 256), static_cast<int>(random() % 256)};
  });
}

/// Even colours, an edge, a point and a gradient.
Pixels shapes(int width, int height, int shift) {
  return make(width, height, [=](int x, int y) {
    int u = x - shift;
    if (u > width / 2 && y > height / 3) return Rgb{210, 60 + 2 * y, 40};
    if (u == 9 && y == 7) return Rgb{255, 255, 255};
    return Rgb{20 + 3 * x, 90, 200 - 2 * y};
  });
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// Of a pixel: the feature error is a root, which makes 3e-4 of what float leaves of 1 (1e-7) where nothing differs.
constexpr double float_noise = 1e-3;

/// The largest difference of a pixel from the slow one.
double disagreement(const Pixels& a, const Pixels& b, int width, int height, double ppd) {
  FlipDifference fast = flip(a, b, width, height, ppd);
  std::vector<double> slow = flip_reference::flip(a, b, width, height, ppd);
  EXPECT_NEAR(fast.mean, mean(slow), 1e-5);
  double largest = 0;
  for (std::size_t i = 0; i < slow.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(fast.map[i]) - slow[i]));
  return largest;
}

TEST(Flip, OfEqualPicturesIsZero) {
  Pixels picture = noise(40, 30, 1);
  FlipDifference difference = flip(picture, picture, 40, 30);
  EXPECT_EQ(difference.mean, 0);
  EXPECT_EQ(difference.map, std::vector<float>(1200, 0.0f));
}

TEST(Flip, DoesNotReadAlpha) {
  Pixels a = noise(16, 16, 1), b = a;
  for (std::size_t i = 3; i < b.size(); i += 4) b[i] = 0;
  EXPECT_EQ(flip(a, b, 16, 16).mean, 0);
}

TEST(Flip, IsSymmetric) {
  Pixels a = noise(32, 20, 1), b = shapes(32, 20, 0);
  EXPECT_EQ(flip(a, b, 32, 20).map, flip(b, a, 32, 20).map);
}

/// Even pictures have no features and are as they are after every filter, so that only the colour metric is left.
/// L* of black and white: 0 and 100, a* = b* = 0; HyAB = 100, and 100^0.7 = 25.119. Green and blue by CIE: L*a*b* =
/// (87.737, −86.185, 83.181) and (32.297, 79.188, −107.860); faded by L*/100 (−75.616, 72.980) and (25.575, −34.836);
/// HyAB = 55.440 + √(101.191² + 107.816²) = 203.306, and 203.306^0.7 = 41.278. So
/// 0.95 + 0.05·(25.119 − 0.4·41.278)/(0.6·41.278) = 0.96738.
TEST(Flip, OfBlackAndWhiteIsWhatTheMetricSays) {
  FlipDifference difference = flip(flat({0, 0, 0}), flat({255, 255, 255}), 24, 24);
  EXPECT_NEAR(difference.mean, 0.96738, 2e-5);
  auto [low, high] = std::minmax_element(difference.map.begin(), difference.map.end());
  EXPECT_NEAR(*low, *high, 1e-6);
}

TEST(Flip, OfGreenAndBlueIsOne) {
  EXPECT_NEAR(flip(flat({0, 255, 0}), flat({0, 0, 255}), 24, 24).mean, 1, 1e-5);
}

/// Grey code 119: linear 0.184475, L* = 50.034, so 50.034^0.7 = 15.470 and 0.95·15.470/(0.4·41.278) = 0.8901.
TEST(Flip, OfBlackAndGreyIsWhatTheMetricSays) {
  EXPECT_NEAR(flip(flat({0, 0, 0}), flat({119, 119, 119}), 24, 24).mean, 0.8901, 1e-4);
}

TEST(Flip, GrowsWithTheDifference) {
  double before = 0;
  for (int step : {1, 3, 10, 30, 80, 150}) {
    double seen = flip(flat({100, 100, 100}), flat({100 + step, 100 + step, 100 + step}), 24, 24).mean;
    EXPECT_GT(seen, before) << step;
    before = seen;
  }
}

TEST(Flip, GrowsWithTheAreaThatDiffers) {
  Pixels even = flat({100, 100, 100});
  double before = 0;
  for (int size : {1, 2, 4, 8, 16}) {
    Pixels spot = make(24, 24, [=](int x, int y) {
      return x < size && y < size ? Rgb{220, 220, 220} : Rgb{100, 100, 100};
    });
    double seen = flip(even, spot, 24, 24).mean;
    EXPECT_GT(seen, before) << size;
    before = seen;
  }
}

/// The eye blurs what is too fine: a checkerboard of pixels is nearly its mean light, from further away more so.
TEST(Flip, FadesWithDistanceWhereDetailIsFine) {
  auto checker = [](int odd) {
    return make(32, 32, [=](int x, int y) { return (x + y) % 2 == odd ? Rgb{200, 200, 200} : Rgb{40, 40, 40}; });
  };
  double near = flip(checker(0), checker(1), 32, 32, 10).mean, far = flip(checker(0), checker(1), 32, 32, 67).mean;
  EXPECT_LT(far, 0.25 * near);
  EXPECT_GT(near, 0.5);
}

/// The edge detector answers 1 where black meets white (its positive weights add up to 1): there a difference of colour
/// counts with the power 1 − √(1/√2).
TEST(Flip, CountsFeaturesThatVanish) {
  auto half = [](int side) {
    return make(64, 32, [=](int x, int) { return x < side ? Rgb{0, 0, 0} : Rgb{255, 255, 255}; });
  };
  FlipDifference difference = flip(half(32), half(64), 64, 32);
  std::vector<double> slow = flip_reference::flip(half(32), half(64), 64, 32, 67);
  std::size_t row = 16 * 64;
  EXPECT_NEAR(difference.map[row + 63], 0.96738, 1e-4) << "far from the edge";
  EXPECT_GT(difference.map[row + 32], 0.97f) << "at the edge";
  EXPECT_NEAR(difference.map[row + 32], slow[row + 32], 1e-5);
}

TEST(Flip, AgreesWithTheSlowOne) {
  for (double ppd : {5.0, 20.0, 67.0}) {
    EXPECT_LT(disagreement(shapes(40, 28, 0), shapes(40, 28, 3), 40, 28, ppd), float_noise) << "shapes, " << ppd;
    EXPECT_LT(disagreement(noise(24, 33, 1), noise(24, 33, 2), 24, 33, ppd), float_noise) << "noise, " << ppd;
  }
}

TEST(Flip, TakesPicturesSmallerThanItsFilters) {
  EXPECT_LT(disagreement(noise(1, 1, 1), noise(1, 1, 2), 1, 1, 67), float_noise);
  EXPECT_LT(disagreement(noise(1, 9, 1), noise(1, 9, 2), 1, 9, 67), float_noise);
  EXPECT_EQ(flip(Pixels{}, Pixels{}, 0, 0).mean, 0);
}

TEST(Flip, StaysFiniteAtTheNearestDistance) {
  for (float value : flip(noise(16, 16, 1), noise(16, 16, 2), 16, 16, 2).map) {
    EXPECT_GE(value, 0.0f);
    EXPECT_LE(value, 1.0f);
  }
}

/// The comparison above can fail: eight codes of 255 in one channel of one pixel are seen.
TEST(Flip, DisagreesWithTheSlowOneOfAnotherPicture) {
  Pixels a = shapes(24, 24, 0), b = shapes(24, 24, 3), other = b;
  other[4 * 300 + 1] = static_cast<std::uint8_t>(other[4 * 300 + 1] ^ 8);
  FlipDifference fast = flip(a, other, 24, 24);
  std::vector<double> slow = flip_reference::flip(a, b, 24, 24, 67);
  EXPECT_GT(std::abs(static_cast<double>(fast.map[300]) - slow[300]), float_noise);
}

}  // namespace
}  // namespace relievo
