#include <gtest/gtest.h>

#include <limits>

#include "relievo/height_map.hpp"
#include "relievo/oracle.hpp"
#include "support/height_maps.hpp"

namespace relievo {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(SampleHeight, AgreesWithVerticalRays) {
  for (const AddressMode mode : test::all_address_modes) {
    const HeightMap map = test::with_address(test::white_noise_map(7, 13), mode);
    const Oracle oracle(map);
    test::Random random(15);
    for (int i = 0; i < 2000; ++i) {
      const bool clip = mode == AddressMode::clip;
      const double u = clip ? random.uniform() : random.uniform(-3, 3),
                   v = clip ? random.uniform() : random.uniform(-3, 3);
      ASSERT_NEAR(sample_height(map, u, v), oracle.trace({u, v, 1, 0, 0, -1}).h, 1e-14) << u << " " << v;
    }
  }
}

TEST(SampleHeight, PassesThroughTexelCentres) {
  for (const AddressMode mode : test::all_address_modes) {
    const HeightMap map = test::with_address(test::white_noise_map(8, 4), mode);
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 8; ++i) EXPECT_EQ(sample_height(map, (i + 0.5) / 8, (j + 0.5) / 4), map.at(i, j));
  }
  const HeightMap map = test::white_noise_map(8, 4);
  EXPECT_EQ(sample_height(map, 1e6 + 0.5 / 8, 0.5 / 4 - 1e6), map.at(0, 0));
  EXPECT_TRUE(std::isfinite(sample_height(map, infinity, std::nan(""))));
}

TEST(WrapTexel, FollowsTheAddressMode) {
  const auto row = [](AddressMode mode) {
    std::vector<int> indices;
    for (int i = -7; i <= 9; ++i) indices.push_back(wrap_texel(i, 3, mode));
    return indices;
  };
  EXPECT_EQ(row(AddressMode::repeat), (std::vector{2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0}));
  EXPECT_EQ(row(AddressMode::mirror), (std::vector{0, 0, 1, 2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1, 2, 2}));
  EXPECT_EQ(row(AddressMode::clamp), (std::vector{0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2, 2, 2}));
  EXPECT_EQ(row(AddressMode::clip), row(AddressMode::clamp));
  for (const AddressMode mode : test::all_address_modes)
    for (const std::int64_t far : {INT64_MIN, INT64_MAX}) {
      EXPECT_GE(wrap_texel(far, 7, mode), 0);
      EXPECT_LT(wrap_texel(far, 7, mode), 7);
    }
}

TEST(AddressModeNames, ParseBack) {
  for (const AddressMode mode : test::all_address_modes) EXPECT_EQ(parse_address_mode(to_string(mode)), mode);
  const auto unknown = parse_address_mode("border");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().id, "address.unknown");
  EXPECT_NE(unknown.error().message.find("border"), std::string::npos);
}

}  // namespace
}  // namespace relievo
