/// The pyramid of least rises: every node bounds its texels, and what breaks that is found.
#include "support/certify.hpp"

namespace relievo::test {
namespace {

TEST(CertifyRisePyramid, TheTopHasTheLeastRiseOfTheMap) {
  const HeightMap map = with_address(white_noise_map(7, 13), AddressMode::repeat);
  const MapData pyramid = baked(map, "rise_pyramid");
  float least = 1;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) least = std::min(least, map.at((x + 1) % 7, y) - map.at(x, y));
  }
  EXPECT_EQ(pyramid.texels[element(pyramid, 0, 0, 0, pyramid.levels - 1)], least);
}

TEST(CertifyRisePyramid, BeyondAnEdgeTheSurfaceGoesOnAsTheAddressModeSays) {
  const HeightMap map = constant_map(4, 4, 0.5);
  EXPECT_EQ(baked(with_address(map, AddressMode::clamp), "rise_pyramid").texels[1], 0.0f);
  EXPECT_EQ(baked(with_address(map, AddressMode::mirror), "rise_pyramid").texels[1], -0.5f) << "falls to the base";
}

TEST(CertifyRisePyramid, ANodeThatSaysTooMuchIsNamed) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData good = baked(map, "rise_pyramid");
  EXPECT_EQ(certified(map, good).checked, 7U * 13U * 4U * 3U)
      << "every texel's four rises in each of the levels of 2 x 4";
  for (int channel = 0; channel < 4; ++channel) {
    MapData faulty = good;
    const std::size_t changed = element(faulty, 0, 1, channel, 1);
    faulty.texels.set(changed, good.texels[changed] + 1e-6f);
    const Certificate broken = certified(map, faulty);
    EXPECT_EQ(broken.violations, 1U);
    EXPECT_EQ(std::tuple(broken.x, broken.y, broken.level), std::tuple(0, 1, 1));
  }
}

TEST(CertifyRisePyramid, OtherShapesAreRefused) {
  const MapData pyramid = baked(white_noise_map(7, 13), "rise_pyramid");
  EXPECT_EQ(std::pair(pyramid.width, pyramid.height), std::pair(2, 4)) << "for 8 x 16";
  EXPECT_EQ(pyramid.levels, 3);
  EXPECT_EQ(certify(white_noise_map(9, 13), pyramid).error().id, "certify.shape");
  EXPECT_EQ(baked(white_noise_map(1, 1), "rise_pyramid").levels, 1);
}

}  // namespace
}  // namespace relievo::test
