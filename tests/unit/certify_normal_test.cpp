/// Normals: unit length and central differences, and what differs is found.
#include "support/certify.hpp"

namespace relievo::test {
namespace {

constexpr const char* name = "normal";

TEST(CertifyNormal, FlatAndSteepMapsKeepThePromise) {
  for (const auto& [title, map] : small_maps()) {
    for (const double scale : {1e-6, 0.1, 1e4}) {
      const std::map<std::string, double> values = {{"normal.scale", scale}};
      const Certificate certificate = certified(map, baked(map, name, values), values);
      EXPECT_EQ(certificate.violations, 0U) << title << " at scale " << scale << ": " << certificate.worst;
      EXPECT_EQ(certificate.checked, map.texels.size());
    }
  }
}

TEST(CertifyNormal, ARampHasTheNormalOfItsSlope) {
  const HeightMap map = ramp_map(16, 8);
  const MapData normals = baked(map, name);
  const double slope = 0.1 * 16.0 / 15.0, size = std::sqrt(1 + slope * slope);
  EXPECT_NEAR(normals.texels[element(normals, 5, 3, 0)], -slope / size, 1e-6);
  EXPECT_EQ(normals.texels[element(normals, 5, 3, 1)], 0);
  EXPECT_NEAR(normals.texels[element(normals, 5, 3, 2)], 1 / size, 1e-6);
}

TEST(CertifyNormal, ANormalThatDiffersIsNamed) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData good = baked(map, name);
  EXPECT_EQ(certified(map, good).violations, 0U);
  MapData longer = good, turned = good;
  const std::size_t x = element(good, 3, 4, 0);
  for (std::size_t i = x; i < x + 3; ++i) longer.texels.set(i, good.texels[i] * 1.00001f);
  turned.texels.set(x, good.texels[x + 1]);
  turned.texels.set(x + 1, good.texels[x]);
  for (const MapData& faulty : {longer, turned}) {
    const Certificate broken = certified(map, faulty);
    EXPECT_EQ(broken.violations, 1U);
    EXPECT_EQ(std::pair(broken.x, broken.y), std::pair(3, 4));
  }
}

TEST(CertifyNormal, FaultsOfAWholeMapAreFound) {
  const HeightMap map = white_noise_map(7, 13);
  const MapData good = baked(map, name);
  EXPECT_EQ(certified(map, good, {{"normal.scale", 0.2}}).violations, 7U * 13U) << "twice as high as it was baked";
  EXPECT_GT(certified(map, baked(with_address(map, AddressMode::clamp), name)).violations, 20U) << "its borders";
  MapData inverted = good;
  for (std::size_t i = 0; i < inverted.texels.size(); i += 3) inverted.texels.set(i, -good.texels[i]);
  EXPECT_GT(certified(map, inverted).violations, 80U);
  const auto refused = certify(map, good, certify_options({{"normal.scale", -1}}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().id, "certify.parameter");
}

}  // namespace
}  // namespace relievo::test
