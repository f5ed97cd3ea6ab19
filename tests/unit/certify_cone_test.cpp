/// Classic cone maps: what the bake promises of texel centres, what the certifier finds between them, and that both
/// notice faults.
#include <gtest/gtest.h>

#include "support/certify.hpp"

namespace relievo::test {
namespace {

/// Texels from i to the nearest image of j.
int gap(int i, int j, int extent, AddressMode mode) {
  const int direct = std::abs(i - j);
  return mode == AddressMode::repeat ? std::min(direct, extent - direct) : direct;
}

/// Radius over height, in texels, of the widest cone on texel (x, y) that holds no other texel's centre.
double widest_cone(const HeightMap& map, int x, int y) {
  double widest = std::max(map.width, map.height);
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      const double rise = double(map.at(i, j)) - map.at(x, y);
      const double distance = std::hypot(gap(x, i, map.width, map.address), gap(y, j, map.height, map.address));
      if (rise > 0) widest = std::min(widest, distance / rise);
    }
  }
  return widest;
}

double ratio_at(const MapData& map, int x, int y) {
  const double encoded = map.texels[static_cast<std::size_t>(y * map.width + x)];
  return encoded * encoded * std::max(map.width, map.height);
}

TEST(CertifyCone, ThePrunedSearchFindsWhatTheExhaustiveOneDoes) {
  for (const auto& [name, map] : addressed_maps()) {
    if (map.address == AddressMode::mirror || map.address == AddressMode::clip) continue;  // baked like clamp
    if (map.width == 16 && map.height == 16) continue;
    EXPECT_EQ(baked(map, "cone", {}).texels, baked(map, "cone", {{"cone.exhaustive", 1}}).texels) << name;
  }
}

/// Two texels far apart that bound the cones of a third all but equally.
TEST(CertifyCone, WhichOfTwoThatBoundAConeAlikeIsMetFirstDoesNotMatter) {
  HeightMap two = with_address(constant_map(1, 20, 0), AddressMode::mirror);  // 6² and a little less, for texel 14
  two.texels[8] = 1;
  two.texels[12] = 1 / 3.0f;
  HeightMap five = with_address(constant_map(42, 1, 0), AddressMode::clamp);  // for texel 31
  for (const int x : {2, 16}) five.texels[static_cast<std::size_t>(x)] = 0.6f;
  for (const int x : {7, 11, 12}) five.texels[static_cast<std::size_t>(x)] = 0.8f;
  for (const HeightMap& map : {two, five}) {
    for (const std::string name : {"cone", "relaxed_cone"})
      EXPECT_EQ(baked(map, name, {}).texels, baked(map, name, {{name + ".exhaustive", 1}}).texels) << name;
  }
}

TEST(CertifyCone, EveryConeIsTheWidestThatHoldsNoOtherTexel) {
  for (const auto& [name, map] : addressed_maps()) {
    const MapData cones = baked(map, "cone", {});
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        const double widest = widest_cone(map, x, y);
        EXPECT_LE(ratio_at(cones, x, y), widest) << name;
        EXPECT_GE(ratio_at(cones, x, y), 0.99999 * widest) << name << ": four float roundings, not more";
      }
    }
  }
}

TEST(CertifyCone, AToleranceThatIsNoNumberIsRefused) {
  const HeightMap map = smooth_noise_map(8, 8);
  CertifyOptions options;
  for (const double tolerance : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    options.tolerance = tolerance;
    const auto certificate = certify(map, baked(map, "cone", {}), options);
    ASSERT_FALSE(certificate);
    EXPECT_EQ(certificate.error().id, "certify.tolerance");
  }
}

TEST(CertifyCone, BackendsBakeTheSameCones) {
  const HeightMap map = smooth_noise_map(33, 20);
  EXPECT_EQ(baked(map, "cone", {}, "vulkan").texels, baked(map, "cone", {}, "opengl").texels);
}

TEST(CertifyCone, WhereOneTexelIsAllThereIsTheClassicConesAreSafeInAllBits) {
  for (AddressMode mode : all_address_modes) {
    for (double bits : {8, 16, 32}) {
      const HeightMap map = with_address(spike_map(13, 7), mode);
      const Certificate certificate = certified(map, baked(map, "cone", {{"cone.bits", bits}}));
      EXPECT_EQ(certificate.checked, 91U);
      EXPECT_EQ(certificate.violations, 0U) << to_string(mode) << ", " << bits << " bits";
    }
  }
}

TEST(CertifyCone, FewerBitsNeverWidenACone) {
  const HeightMap map = smooth_noise_map(33, 20);
  const MapData exact = baked(map, "cone", {});
  for (double bits : {8, 16}) {
    const MapData rounded = baked(map, "cone", {{"cone.bits", bits}});
    for (std::size_t i = 0; i < exact.texels.size(); ++i) {
      EXPECT_LE(rounded.texels[i], exact.texels[i]);
      EXPECT_GT(rounded.texels[i], exact.texels[i] - 1.01 / (std::exp2(bits) - 1));
    }
  }
}

/// Two towers touch a cone from outside; the edge that joins them passes through it.
TEST(CertifyCone, AnEdgeBetweenTexelsViolatesClassicCones) {
  HeightMap map = constant_map(16, 16, 0);
  map.texels[8 * 16 + 10] = 0.5f, map.texels[9 * 16 + 10] = 0.56f;
  MapData cones = baked(map, "cone", {});
  for (std::size_t i = 0; i < cones.texels.size(); ++i)
    if (i != 8 * 16 + 8) cones.texels.set(i, 0);  // all but the cone on (8, 8)
  const Certificate certificate = certified(map, cones);
  EXPECT_EQ(certificate.violations, 1U);
  // Half way the edge is 0.53 high at a distance of sqrt(4.25); the second tower allows 0.56 per sqrt(5).
  EXPECT_NEAR(certificate.worst, 0.53 - 0.56 * std::sqrt(4.25 / 5), 2e-3);
}

/// The height above the cone of every point of a fine grid.
double sampled_excess(const HeightMap& map, const MapData& cones, int x, int y) {
  constexpr int samples = 16, reach = 20;
  const double slope = 1 / ratio_at(cones, x, y);
  double excess = 0;
  for (int j = -reach * samples; j <= reach * samples; ++j) {
    for (int i = -reach * samples; i <= reach * samples; ++i) {
      const double dx = double(i) / samples, dy = double(j) / samples;
      const double height = sample_height(map, (x + 0.5 + dx) / map.width, (y + 0.5 + dy) / map.height);
      excess = std::max(excess, height - map.at(x, y) - slope * std::hypot(dx, dy));
    }
  }
  return excess;
}

TEST(CertifyCone, TheWorstViolationIsWhatDenseSamplingFinds) {
  for (AddressMode mode : {AddressMode::repeat, AddressMode::mirror, AddressMode::clamp}) {
    const HeightMap map = with_address(white_noise_map(7, 13), mode);
    const MapData cones = baked(map, "cone", {});
    const Certificate certificate = certified(map, cones);
    EXPECT_GT(certificate.violations, 0U);
    const double sampled = sampled_excess(map, cones, certificate.x, certificate.y);
    EXPECT_LE(sampled, certificate.worst + 1e-9);
    EXPECT_GE(sampled, certificate.worst - 0.01) << "1/16 texel apart";
    EXPECT_LE(sampled_excess(map, cones, 3, 5), certificate.worst + 1e-9);
  }
}

TEST(CertifyCone, AWiderConeIsCaught) {
  const HeightMap map = spike_map(13, 7);
  MapData cones = baked(map, "cone", {});
  ASSERT_EQ(certified(map, cones).violations, 0U);
  cones.texels.set(2 * 13 + 4, cones.texels[2 * 13 + 4] * 1.01f);
  const Certificate certificate = certified(map, cones);
  EXPECT_EQ(certificate.violations, 1U);
  EXPECT_EQ(std::pair(certificate.x, certificate.y), std::pair(4, 2));
  EXPECT_GT(certificate.worst, 0.01);
  EXPECT_EQ(certify(map, cones, {{}, 0.1})->violations, 0U) << "within the tolerance";
}

TEST(CertifyCone, ANegativeConeIsCaught) {
  const HeightMap map = constant_map(4, 4, 0.5);
  MapData cones = baked(map, "cone", {});
  cones.texels.set(5, -0.5f);
  EXPECT_EQ(certified(map, cones).violations, 1U);
}

TEST(CertifyCone, AMapOfAnotherShapeIsAnError) {
  const HeightMap map = constant_map(4, 4, 0.5);
  const Result<Certificate> certificate = certify(constant_map(5, 4, 0.5), baked(map, "cone", {}));
  ASSERT_FALSE(certificate);
  EXPECT_EQ(certificate.error().id, "certify.shape");
}

}  // namespace
}  // namespace relievo::test
