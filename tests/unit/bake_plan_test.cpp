/// How bakes are dealt out to Jobs and storage buffers.
#include "maps/bake_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relievo {
namespace {

constexpr std::size_t mib = std::size_t{1} << 20;

struct Bake {
  MapDescriptor map;
  MapData output, height;
  BackendInfo backend;

  Result<BakePlan> plan() const { return plan_bake(output, map, height, backend); }
};

/// Eight layers of three floats a texel; with repeat they are apart.
Bake sectors(int extent) {
  Bake bake;
  bake.map.passes = {1, 27, 1, 1};
  bake.map.layers_apart = {"repeat"};
  bake.output = {"sectors", extent, extent, 3, {}};
  bake.output.depth = 8;
  bake.height = {"height", extent, extent, 1, {}};
  bake.backend.name = "small";
  return bake;
}

TEST(BakePlan, SmallMapsAreOneJobOfOneBuffer) {
  const auto plan = sectors(64).plan();
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->layers, 8);
  EXPECT_EQ(plan->buffers(8), 1U);
  EXPECT_EQ(plan->in_buffer(0, 8), 8U * 3 * 64 * 64);
}

TEST(BakePlan, LayersThatAreApartTakeFourTimesTheHeightMapAtATime) {
  const Bake bake = sectors(2048);
  const auto plan = bake.plan();
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->layers, 1);
  EXPECT_EQ(plan->in_buffer(0, 1) * sizeof(float), 48 * mib);
  EXPECT_EQ(sectors(512).plan()->layers, 2) << "8 MiB in any case";
}

TEST(BakePlan, LayersThatReadOneAnotherStayTogetherInSeveralBuffers) {
  Bake bake = sectors(2048);
  bake.backend.max_storage_buffer = 128 * mib;
  bake.output.address = AddressMode::mirror;
  const auto plan = bake.plan();
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->layers, 8);
  EXPECT_EQ(plan->buffers(8), 3U);
  EXPECT_EQ(plan->in_buffer(2, 8) * sizeof(float), 128 * mib);
}

TEST(BakePlan, OnePassReadsNoOtherLayer) {
  Bake bake = sectors(2048);
  bake.map.passes = {1};
  bake.output.address = AddressMode::mirror;
  EXPECT_EQ(bake.plan()->layers, 1);
}

TEST(BakePlan, LayersOfOneRunStayTogetherWhereTheyFit) {
  Bake bake = sectors(512);  // 3 MiB a layer
  bake.map.passes = {1};
  bake.map.layers_at_once = 2;
  bake.output.depth = 9;
  bake.backend.max_storage_buffer = 128 * mib;
  bake.height = {"height", 1024, 1024, 1, {}};
  EXPECT_EQ(bake.plan()->layers, 4) << "of five that fit";
  bake.height.width = bake.height.height = 2048;
  EXPECT_EQ(bake.plan()->layers, 9) << "all";
  bake.backend.max_storage_buffer = 4 * mib;
  EXPECT_EQ(bake.plan()->layers, 1);
}

TEST(BakePlan, MoreFloatsThanShadersCountAreRefused) {
  Bake bake = sectors(10000);
  bake.output.address = AddressMode::mirror;
  const auto plan = bake.plan();
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().id, "maps.too-large");
  EXPECT_THAT(plan.error().message, testing::HasSubstr("takes 9600000000 bytes at once; expected at most 8589934588"));
}

}  // namespace
}  // namespace relievo
