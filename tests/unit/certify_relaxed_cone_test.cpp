/// Relaxed cone maps: wider than classic ones, bounded by the far sides of what rises above a texel; and the certifier
/// notices cones that reach beyond.
#include <gtest/gtest.h>

#include "support/certify.hpp"

namespace relievo::test {
namespace {

double ratio_at(const MapData& map, int x, int y) {
  const double encoded = map.texels[static_cast<std::size_t>(y * map.width + x)];
  return encoded * encoded * std::max(map.width, map.height);
}

TEST(CertifyRelaxedCone, ThePrunedSearchFindsWhatTheExhaustiveOneDoes) {
  for (const auto& [name, map] : addressed_maps()) {
    if (map.width != 7 && map.width != 33 && map.height != 9) continue;  // the awkward sizes are enough
    for (double from_lid : {0, 1}) {
      const std::map<std::string, double> values = {{"relaxed_cone.from_lid", from_lid}};
      auto exhaustive = values;
      exhaustive["relaxed_cone.exhaustive"] = 1;
      EXPECT_EQ(baked(map, "relaxed_cone", values).texels, baked(map, "relaxed_cone", exhaustive).texels) << name;
    }
  }
}

TEST(CertifyRelaxedCone, RelaxedConesHoldTheClassicOnes) {
  const HeightMap hills =
      make_map(40, 24, [](int i, int j) { return 0.5 + 0.3 * std::sin(i * 0.314) * std::sin(j * 0.2618); });
  for (const HeightMap& map : {hills, white_noise_map(7, 13)}) {
    const MapData classic = baked(map, "cone", {}), relaxed = baked(map, "relaxed_cone", {});
    const MapData published = baked(map, "relaxed_cone", {{"relaxed_cone.from_lid", 1}});
    int wider = 0;
    for (std::size_t i = 0; i < classic.texels.size(); ++i) {
      EXPECT_LE(classic.texels[i], relaxed.texels[i]);
      EXPECT_LE(relaxed.texels[i], published.texels[i]) << "rays from the lid alone are fewer";
      wider += relaxed.texels[i] > classic.texels[i];
    }
    EXPECT_GT(wider, map.width == 40 ? 400 : -1) << "noise has no slopes to be wider over";
  }
}

TEST(CertifyRelaxedCone, BackendsBakeTheSameCones) {
  const HeightMap map = smooth_noise_map(33, 20);
  EXPECT_EQ(baked(map, "relaxed_cone", {}, "vulkan").texels, baked(map, "relaxed_cone", {}, "opengl").texels);
}

/// Treads 4 texels long, each 1/7 above the one before: from below every riser is entered and none is left before the
/// map falls from 1 to 0. The classic cone ends at the next riser.
TEST(CertifyRelaxedCone, AStaircaseIsNoObstacleFromBelow) {
  const HeightMap map = with_address(staircase_map(32, 4), AddressMode::clip);
  const MapData classic = baked(map, "cone", {}), relaxed = baked(map, "relaxed_cone", {});
  EXPECT_NEAR(ratio_at(classic, 3, 1), 7, 1e-3) << "one texel for 1/7";
  EXPECT_NEAR(ratio_at(relaxed, 3, 1), 32, 1e-3) << "one longer side: the widest there is";
}

/// A roof: seen from its foot the front rises to the ridge 8 texels away; behind it, it falls.
TEST(CertifyRelaxedCone, ARoofBoundsTheConeAtItsRidge) {
  const HeightMap map = with_address(ridge_map(33, 4, true, 16), AddressMode::clamp);  // 0 at 0, 16, 32; 1 at 8, 24
  const MapData relaxed = baked(map, "relaxed_cone", {});
  EXPECT_NEAR(ratio_at(relaxed, 16, 1), 8, 1e-3);
  EXPECT_EQ(certified(map, relaxed).violations, 0U);
}

TEST(CertifyRelaxedCone, AWiderConeIsCaught) {
  const HeightMap map = with_address(ridge_map(33, 4, true, 16), AddressMode::clamp);
  MapData relaxed = baked(map, "relaxed_cone", {});
  relaxed.texels.set(1 * 33 + 16, relaxed.texels[1 * 33 + 16] * 1.3f);
  const Certificate certificate = certified(map, relaxed);
  EXPECT_EQ(certificate.violations, 1U);
  EXPECT_EQ(std::pair(certificate.x, certificate.y), std::pair(16, 1));
  EXPECT_GT(certificate.worst, 0.2);
}

TEST(CertifyRelaxedCone, OnNoiseFewConesAreViolatedAndOfTheWidestMost) {
  for (AddressMode mode : all_address_modes) {
    const HeightMap map = with_address(white_noise_map(16, 16), mode);
    MapData relaxed = baked(map, "relaxed_cone", {});
    const Certificate certificate = certified(map, relaxed);
    EXPECT_EQ(certificate.checked, 256U);
    EXPECT_LT(certificate.violations, 13U) << "ridges between texels: up to 5 %";
    relaxed.texels = std::vector<float>(relaxed.texels.size(), 1.0f);
    EXPECT_GT(certified(map, relaxed).violations, 150U);
  }
}

TEST(CertifyRelaxedCone, FewerBitsNeverWidenACone) {
  const HeightMap map = smooth_noise_map(33, 20);
  const MapData exact = baked(map, "relaxed_cone", {});
  for (double bits : {8, 16}) {
    const MapData rounded = baked(map, "relaxed_cone", {{"relaxed_cone.bits", bits}});
    for (std::size_t i = 0; i < exact.texels.size(); ++i) EXPECT_LE(rounded.texels[i], exact.texels[i]);
  }
}

/// The technique and its map share a name: a value goes to whichever has such a parameter.
TEST(CertifyRelaxedCone, ValuesOfTheTechniqueDoNotReachTheMap) {
  const HeightMap map = ridge_map(32, 16, true);
  const std::vector<Ray> rays = {{0.1, 0.2, 1, 0.3, 0.1, -1}};
  for (double finish : {0, 1}) {
    const auto hits = trace_on("vulkan", map, rays,
                               request_of("relaxed_cone", {{"relaxed_cone.binary_steps", 20},
                                                           {"relaxed_cone.finish", finish},
                                                           {"relaxed_cone.from_lid", 1},
                                                           {"relaxed_cone.bits", 8}}));
    EXPECT_NEAR(hits[0].t, Oracle(map).trace(rays[0]).t, 1e-4);
  }
}

}  // namespace
}  // namespace relievo::test
