#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "relievo/measure.hpp"

namespace relievo {
namespace {

using Surface = std::array<double, 2>;
using View = std::function<Surface(double, double)>;  // of pixel coordinates

constexpr int width = 64, height = 48;

Image picture(const View& view) {
  Image image{width, height, 4, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Surface s = view(x, y);
      for (double value : {s[0], s[1], 0.5, 1.0}) image.pixels.push_back(static_cast<float>(value));
    }
  }
  return image;
}

View moved(const View& view, double dx, double dy) {
  return [=](double x, double y) { return view(x + dx, y + dy); };
}

/// A turned and stretched texture.
Surface turned(double x, double y) {
  return {0.1 + 0.006 * x + 0.002 * y, 0.8 - 0.001 * x - 0.009 * y};
}

/// Seen along the ground: what a pixel shows grows towards the horizon.
Surface ground(double x, double y) {
  double depth = 20 / (y + 30);
  return {0.5 + 0.01 * depth * (x - width / 2.0), 0.3 * depth};
}

/// A relief of two steps that hide the texture between 0.4 and 0.5.
Surface step(double x, double y) {
  return {x < 32 ? 0.4 * x / 32 : 0.5 + 0.01 * (x - 32), 0.01 * y};
}

TEST(PixelOffsets, OfEqualPicturesAreZero) {
  for (const View& view : {View(turned), View(ground), View(step)}) {
    PixelOffsets offsets = pixel_offsets(picture(view), picture(view));
    EXPECT_EQ(offsets.judged, 64u * 48u);
    EXPECT_EQ(offsets.lost, 0u);
    EXPECT_EQ(offsets.pixels.max, 0);
  }
}

TEST(PixelOffsets, AreTheDistanceThatAPictureIsMovedBy) {
  for (auto [dx, dy] : {std::pair{1.0, 0.0}, {0.0, -2.0}, {3.0, 4.0}, {0.25, 0.0}, {-0.3, 0.4}}) {
    double distance = std::hypot(dx, dy);
    PixelOffsets offsets = pixel_offsets(picture(turned), picture(moved(turned, dx, dy)));
    EXPECT_NEAR(offsets.pixels.p50, distance, 1e-3) << dx << ' ' << dy;
    EXPECT_NEAR(offsets.pixels.p99, distance, 1e-3) << dx << ' ' << dy;
    EXPECT_LE(offsets.lost_percent(), 100 * (std::abs(dx) / width + std::abs(dy) / height) + 4)
        << "no more than what left the frame";
  }
}

TEST(PixelOffsets, AreRightBetweenPixelsInPerspective) {
  PixelOffsets offsets = pixel_offsets(picture(ground), picture(moved(ground, 0.5, 0.5)));
  EXPECT_NEAR(offsets.pixels.p50, std::sqrt(0.5), 0.02);
  EXPECT_NEAR(offsets.pixels.max, std::sqrt(0.5), 0.02);
}

TEST(PixelOffsets, CountWhatLeftTheFrameAsLost) {
  PixelOffsets offsets = pixel_offsets(picture(turned), picture(moved(turned, 8, 0)));
  EXPECT_EQ(offsets.lost, 8u * 48u);
  EXPECT_NEAR(offsets.pixels.max, 8, 1e-3);
}

TEST(PixelOffsets, CountHiddenFeaturesFromTheEdgeThatHidesThem) {
  Image image = picture(step);
  image.pixels[4 * (20 * width + 40)] = 0.45f;  // hidden, between the pixels 31 and 32
  PixelOffsets offsets = pixel_offsets(picture(step), image);
  EXPECT_EQ(offsets.lost, 0u);
  EXPECT_GT(offsets.pixels.max, 8);
  EXPECT_LT(offsets.pixels.max, 9);
}

TEST(PixelOffsets, AreSmallAtOutlinesThatHardlyMoved) {
  View nudged = [](double x, double y) { return turned(x - 1e-3, y - 1e-3); };
  PixelOffsets offsets = pixel_offsets(picture(turned), picture(nudged));
  EXPECT_EQ(offsets.lost, 0u) << "the first row and column lie outside all triangles";
  EXPECT_LT(offsets.pixels.max, 2e-2);
}

TEST(PixelOffsets, GoRoundTheTexture) {
  View tiled = [](double x, double y) { return Surface{0.9 + 0.004 * x, 0.99 + 0.004 * y}; };
  View wrapped = [&](double x, double y) {
    Surface s = tiled(x, y);
    return Surface{s[0] - std::floor(s[0]), s[1] - std::floor(s[1])};
  };
  PixelOffsets offsets = pixel_offsets(picture(wrapped), picture(moved(tiled, 2, 0)));
  EXPECT_NEAR(offsets.pixels.p50, 2, 1e-3);
  EXPECT_NEAR(offsets.pixels.max, 2, 1e-3);
  EXPECT_EQ(offsets.lost, 2u * 48u);
}

TEST(PixelOffsets, TakeTheNearestOfSeveralPlaces) {
  View tiles = [](double x, double y) { return Surface{x / 16, 0.01 * y}; };
  EXPECT_NEAR(pixel_offsets(picture(tiles), picture(moved(tiles, 3, 0))).pixels.p50, 3, 1e-3);
  EXPECT_NEAR(pixel_offsets(picture(tiles), picture(moved(tiles, 14, 0))).pixels.p50, 2, 1e-3);
}

TEST(PixelOffsets, JudgeWhatBothPicturesDraw) {
  Image a = picture(turned), b = picture(turned);
  a.pixels[3] = 0;
  b.pixels[7] = 0;
  b.pixels[8] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(pixel_offsets(a, b).judged, 64u * 48u - 3);
  Image empty{width, height, 4, std::vector<float>(4 * width * height)};
  EXPECT_EQ(pixel_offsets(empty, empty).judged, 0u);
  EXPECT_TRUE(std::isnan(pixel_offsets(empty, empty).lost_percent()));
}

/// One pixel of many that moved is seen in the largest offset, and in no quantile that it is too few for.
TEST(PixelOffsets, FindOnePixelThatMoved) {
  Image image = picture(turned);
  Surface elsewhere = turned(30, 30);
  float* pixel = &image.pixels[4 * (20 * width + 30)];
  pixel[0] = static_cast<float>(elsewhere[0]), pixel[1] = static_cast<float>(elsewhere[1]);
  PixelOffsets offsets = pixel_offsets(picture(turned), image);
  EXPECT_NEAR(offsets.pixels.max, 10, 1e-3);
  EXPECT_EQ(offsets.pixels.p99, 0);
}

}  // namespace
}  // namespace relievo
