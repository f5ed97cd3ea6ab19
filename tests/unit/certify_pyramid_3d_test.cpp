/// The packed pyramid: every level is where the packing says, and what breaks its promise is found.
#include "support/certify.hpp"

namespace relievo::test {
namespace {

constexpr const char* name = "pyramid_3d";

TEST(CertifyPyramid3d, LayersHoldTheLevelsOfTheMaximumPyramid) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData packed = baked(map, name), pyramid = baked(map, "max_pyramid");
  ASSERT_EQ(packed.dimension, MapDimension::volume);
  ASSERT_EQ(std::tuple(packed.width, packed.height, packed.depth), std::tuple(7, 13, 2));
  // Level 1 is 4 x 7; the others follow one another along v, beyond it.
  const int origins[][2] = {{0, 0}, {0, 0}, {4, 0}, {4, 4}, {4, 6}};
  for (int level = 0; level <= 4; ++level) {
    for (int y = 0; y <= (13 - 1) >> level; ++y) {
      for (int x = 0; x <= (7 - 1) >> level; ++x) {
        const std::size_t at = element(packed, origins[level][0] + x, origins[level][1] + y, 0, 0, level > 0);
        EXPECT_EQ(packed.texels[at], pyramid.texels[element(pyramid, x, y, 0, level)]) << level << " " << x << " " << y;
      }
    }
  }
}

TEST(CertifyPyramid3d, LevelsNeverOverlapOrLeaveTheMap) {
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(1, 9), std::pair(9, 1), std::pair(2, 2), std::pair(5, 2), std::pair(2, 5),
        std::pair(5, 4), std::pair(3, 3), std::pair(33, 20)}) {
    const HeightMap map = white_noise_map(width, height);
    const Certificate certificate = certified(map, baked(map, name));
    EXPECT_EQ(certificate.violations, 0U) << width << " x " << height;
    if (std::min(width, height) == 1) continue;
    const auto levels = static_cast<unsigned>(std::bit_width(static_cast<unsigned>(std::max(width, height) - 1))) + 1;
    EXPECT_EQ(certificate.checked, static_cast<unsigned>(width * height) * levels) << width << " x " << height;
  }
}

TEST(CertifyPyramid3d, ATexelThatBreaksThePromiseIsNamed) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData good = baked(map, name);
  EXPECT_EQ(certified(map, good).violations, 0U);
  MapData faulty = good;
  const std::size_t node = element(faulty, 5, 1, 0, 0, 1);  // (1, 1) of level 2
  faulty.texels.set(node, good.texels[node] - 1e-6f);
  const Certificate broken = certified(map, faulty);
  EXPECT_GE(broken.violations, 1U);
  EXPECT_LE(broken.violations, 4U) << "the cells of one corner";
  EXPECT_EQ(std::tuple(broken.x, broken.y, broken.level, broken.layer), std::tuple(1, 1, 2, 1));
}

TEST(CertifyPyramid3d, FaultsOfAWholeMapAreFound) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData good = baked(map, name);
  EXPECT_GT(certified(map, rounded_to_nearest(good)).violations, 50U);
  EXPECT_GT(certified(white_noise_map(7, 13, 2), good).violations, 50U) << "another height map's";
  MapData swapped = good;
  rotate_texels(swapped, 7 * 13);
  EXPECT_GT(certified(map, swapped).violations, 50U) << "its layers in the other order";
  MapData flat = good;
  flat.dimension = MapDimension::flat;
  flat.depth = 1;
  EXPECT_EQ(certify(map, flat).error().id, "certify.shape");
}

}  // namespace
}  // namespace relievo::test
