/// The maps of cones: what they promise is kept with every address mode, size and number of bits, and the certifier
/// notices where it is not.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "support/certify.hpp"
#include "support/rotate_texels.hpp"

namespace relievo::test {
namespace {

using Values = std::map<std::string, double>;

std::vector<NamedMap> heights() {
  return {{"1x1", constant_map(1, 1, 0.3)}, {"1x9", white_noise_map(1, 9)},      {"9x1", white_noise_map(9, 1)},
          {"7x13", white_noise_map(7, 13)}, {"64x37", smooth_noise_map(64, 37)}, {"spike", spike_map(40, 33)},
          {"ramp", ramp_map(24, 8)}};
}

void expect_kept(const std::string& name, const Values& values) {
  for (const auto& [title, height] : heights()) {
    for (AddressMode mode : all_address_modes) {
      const HeightMap addressed = with_address(height, mode);
      const Certificate certificate = certified(addressed, baked(addressed, name, values), values);
      EXPECT_GE(certificate.checked, addressed.texels.size());
      EXPECT_EQ(certificate.violations, 0U)
          << fmt::format("{} {} {}: {} at {}, {}, layer {}", name, title, to_string(mode), certificate.worst,
                         certificate.x, certificate.y, certificate.layer);
    }
  }
}

TEST(ConeMaps, RobustConesHoldAtEveryNumberOfBits) {
  for (double bits : {8, 16, 32}) expect_kept("robust_cone", {{"robust_cone.bits", bits}});
}

TEST(ConeMaps, DirectionalConesHoldAtEveryNumberOfBits) {
  for (double bits : {8, 16, 32}) expect_kept("directional_cone", {{"directional_cone.bits", bits}});
}

TEST(ConeMaps, DirectionalConesHoldForEveryNumberOfSectors) {
  for (double sectors : {4, 32})
    expect_kept("directional_cone", {{"directional_cone.sectors", sectors}, {"directional_cone.bits", 32}});
}

TEST(ConeMaps, ConesHoldAsFarAsTheyReach) {
  const HeightMap height = spike_map(660, 3);
  for (const std::string name : {"robust_cone", "directional_cone"}) {
    const Values values = {{name + ".bits", 32}, {name + ".reach", 318}};
    EXPECT_EQ(certified(height, baked(height, name, values), values).violations, 0U) << name;
  }
}

TEST(ConeMaps, AConeThatIsTooNarrowByAStepIsCaught) {
  const HeightMap height = smooth_noise_map(64, 37);
  for (const std::string name : {"robust_cone", "directional_cone"}) {
    for (int channel = 0; channel < 3; ++channel) {
      const Values values = {{name + ".bits", 8}};
      MapData map = baked(height, name, values);
      for (std::size_t i = static_cast<std::size_t>(channel); i < map.texels.size(); i += 3)
        map.texels.set(i, map.texels[i] - (channel == 2 ? 4.0f : 1.0f) / 255.0f);
      EXPECT_GT(certified(height, map, values).violations, 100U) << name << ", channel " << channel;
    }
  }
}

TEST(ConeMaps, SectorsInAnotherOrderAreCaught) {
  const HeightMap height = smooth_noise_map(64, 37);
  MapData map = baked(height, "directional_cone", {});
  rotate_texels(map, 4 * 3 * height.texels.size());
  EXPECT_GT(certified(height, map).violations, 100U);
}

}  // namespace
}  // namespace relievo::test
