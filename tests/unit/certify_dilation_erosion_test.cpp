/// Eroded and dilated heights: the promise holds on the surface around every cell, and what breaks it is found.
#include "support/certify.hpp"

namespace relievo::test {
namespace {

constexpr const char* name = "dilation_erosion";
const std::map<std::string, double> radius_2 = {{"dilation_erosion.radius", 2}},
                                    radius_3 = {{"dilation_erosion.radius", 3}};

TEST(CertifyDilationErosion, TheSurfaceAroundEveryCellLiesBetweenItsValues) {
  constexpr int radius = 2;
  for (const AddressMode mode : all_address_modes) {
    const HeightMap map = with_address(white_noise_map(7, 13), mode);
    const MapData extremes = baked(map, name, radius_2);
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
      const int x = random.below(map.width), y = random.below(map.height);
      const SurfacePoint near =
          surface_point(map, random.uniform(x - radius, x + 1 + radius), random.uniform(y - radius, y + 1 + radius));
      ASSERT_LE(extremes.texels[element(extremes, x, y, 0)], near.height + 1e-12) << to_string(mode);
      ASSERT_GE(extremes.texels[element(extremes, x, y, 1)], near.height - 1e-12) << to_string(mode);
    }
  }
}

TEST(CertifyDilationErosion, ATexelThatBreaksThePromiseIsNamed) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData good = baked(map, name, radius_2);
  const Certificate kept = certified(map, good, radius_2);
  EXPECT_EQ(kept.violations, 0U);
  EXPECT_EQ(kept.checked, 7U * 13U);
  for (const int channel : {0, 1}) {
    MapData faulty = good;
    const std::size_t changed = element(faulty, 5, 11, channel);
    faulty.texels.set(changed, good.texels[changed] + (channel == 0 ? 1e-6f : -1e-6f));
    const Certificate broken = certified(map, faulty, radius_2);
    EXPECT_EQ(broken.violations, 1U);
    EXPECT_EQ(std::pair(broken.x, broken.y), std::pair(5, 11));
  }
}

TEST(CertifyDilationErosion, FaultsOfAWholeMapAreFound) {
  const HeightMap map = white_noise_map(64, 64);
  const MapData good = baked(map, name, radius_2);
  EXPECT_GT(certified(map, good, radius_3).violations, 1000U) << "its radius is smaller than it claims";
  EXPECT_GT(certified(map, good).violations, 1000U) << "the default is 4";
  EXPECT_GT(certified(map, rounded_to_nearest(good), radius_2).violations, 1000U);
  EXPECT_GT(certified(map, baked(with_address(map, AddressMode::clamp), name, radius_2), radius_2).violations, 50U)
      << "baked for another border";
  MapData shifted = good;
  rotate_texels(shifted, 2);
  EXPECT_GT(certified(map, shifted, radius_2).violations, 500U);
}

TEST(CertifyDilationErosion, ARadiusThatCannotBeIsRefused) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData good = baked(map, name);
  for (const double radius : {0.0, 2.5, 1e9, -3.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto result = certify(map, good, certify_options({{"dilation_erosion.radius", radius}}));
    ASSERT_FALSE(result) << radius;
    EXPECT_EQ(result.error().id, "certify.parameter");
  }
}

TEST(CertifyDilationErosion, ValuesOfTheTechniqueOfThatNameAreNotTheMaps) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData plain = baked(map, name, radius_2);
  std::map<std::string, double> both = radius_2;
  both["dilation_erosion.binary_steps"] = 3;
  EXPECT_EQ(baked(map, name, both).texels, plain.texels);
}

}  // namespace
}  // namespace relievo::test
