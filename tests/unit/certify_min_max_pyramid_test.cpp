/// The minimum and maximum pyramid: its promise holds on the surface itself, and what breaks it is found.
#include "support/certify.hpp"

namespace relievo::test {
namespace {

constexpr const char* name = "min_max_pyramid";

TEST(CertifyMinMaxPyramid, TheSurfaceLiesBetweenTheValuesOfEveryLevel) {
  for (const AddressMode mode : all_address_modes) {
    const HeightMap map = with_address(white_noise_map(7, 13), mode);
    const MapData pyramid = baked(map, name);
    Random random(3);
    for (int i = 0; i < 5000; ++i) {
      const SurfacePoint point = random_surface_point(map, random);
      const int x = cell_read_at(point.x, map.width, mode), y = cell_read_at(point.y, map.height, mode);
      for (int level = 0; level < pyramid.levels; ++level) {
        ASSERT_LE(pyramid.texels[element(pyramid, x >> level, y >> level, 0, level)], point.height + 1e-12);
        ASSERT_GE(pyramid.texels[element(pyramid, x >> level, y >> level, 1, level)], point.height - 1e-12);
      }
    }
  }
}

TEST(CertifyMinMaxPyramid, TheTopIsTheLeastAndGreatestHeightAndNoLooser) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData pyramid = baked(map, name);
  const auto [least, greatest] = std::minmax_element(map.texels.begin(), map.texels.end());
  EXPECT_EQ(pyramid.texels[element(pyramid, 0, 0, 0, pyramid.levels - 1)], *least);
  EXPECT_EQ(pyramid.texels[element(pyramid, 0, 0, 1, pyramid.levels - 1)], *greatest);
}

TEST(CertifyMinMaxPyramid, ATexelThatBreaksThePromiseIsNamed) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData good = baked(map, name);
  const Certificate kept = certified(map, good);
  EXPECT_EQ(kept.violations, 0U);
  EXPECT_EQ(kept.checked, 7U * 13U * 5U) << "every cell in each of the levels of 8 x 16";
  for (const int channel : {0, 1}) {
    MapData faulty = good;
    const std::size_t changed = element(faulty, 1, 2, channel, 1);
    faulty.texels.set(changed, good.texels[changed] + (channel == 0 ? 1e-6f : -1e-6f));
    const Certificate broken = certified(map, faulty);
    EXPECT_GE(broken.violations, 1U);
    EXPECT_LE(broken.violations, 4U) << "no more cells have the extreme for a corner";
    EXPECT_NEAR(broken.worst, 1e-6, 1e-7);
    EXPECT_EQ(std::tuple(broken.x, broken.y, broken.level), std::tuple(1, 2, 1));
  }
}

TEST(CertifyMinMaxPyramid, FaultsOfAWholeMapAreFound) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData good = baked(map, name);
  EXPECT_GT(certified(map, rounded_to_nearest(good)).violations, 50U);
  EXPECT_GT(certified(white_noise_map(7, 13, 2), good).violations, 50U) << "another height map's";
  EXPECT_GT(certified(map, baked(with_address(map, AddressMode::clamp), name)).violations, 5U) << "its borders";
  MapData swapped = good;
  for (std::size_t i = 0; i < swapped.texels.size(); ++i) swapped.texels.set(i, good.texels[i ^ 1]);
  EXPECT_GT(certified(map, swapped).violations, 300U);
}

TEST(CertifyMinMaxPyramid, MapsOfAnotherShapeAndNumbersThatAreNoneAreRefused) {
  const HeightMap map = white_noise_map(7, 13);
  MapData faulty = baked(map, name);
  EXPECT_EQ(certify(white_noise_map(7, 17), faulty).error().id, "certify.shape");
  faulty.texels.set(element(faulty, 1, 1), std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(certify(map, faulty).error().id, "certify.non-finite");
}

TEST(Certify, AMapThatNobodyCertifiesIsRefused) {
  const HeightMap map = white_noise_map(7, 13);
  MapData other = baked(map, name);
  other.name = "other";
  const Result<Certificate> refused = certify(map, other);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().id, "certify.unknown");
  for (const std::string& known : certified_maps())
    EXPECT_NE(refused.error().message.find(known), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace relievo::test
