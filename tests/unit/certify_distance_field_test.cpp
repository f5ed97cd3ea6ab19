/// Distance fields are nowhere too long, in all bits, with all address modes; and the certifier notices one that is.
#include <gtest/gtest.h>

#include "support/certify.hpp"
#include "support/hard_rays.hpp"

namespace relievo::test {
namespace {

using Values = std::map<std::string, double>;

Certificate certified_field(const HeightMap& map, const MapData& field, const Values& values) {
  return certified(map, field, values);
}

std::size_t index_of(const MapData& field, int x, int y, int layer) {
  return static_cast<std::size_t>((layer * field.height + y) * field.width + x);
}

TEST(CertifyDistanceField, NoDistanceIsTooLong) {
  const Values values = {{"distance_field.layers", 9}};
  for (const auto& [name, map] : addressed_maps()) {
    const Certificate certificate = certified_field(map, baked(map, "distance_field", values), values);
    EXPECT_EQ(certificate.checked, map.texels.size() * 9) << name;
    EXPECT_EQ(certificate.violations, 0U) << name << ": " << certificate.worst;
  }
}

TEST(CertifyDistanceField, NorWithFewerBitsOrAnotherScale) {
  const HeightMap map = with_address(white_noise_map(7, 13), AddressMode::repeat);
  for (double bits : {8, 16, 32}) {
    for (double scale : {1e-6, 0.02, 1.0, 1e6}) {
      const Values values = {
          {"distance_field.layers", 32}, {"distance_field.scale", scale}, {"distance_field.bits", bits}};
      EXPECT_EQ(certified_field(map, baked(map, "distance_field", values), values).violations, 0U)
          << bits << " bits, scale " << scale;
    }
  }
}

TEST(CertifyDistanceField, BackendsBakeTheSameField) {
  const HeightMap map = smooth_noise_map(33, 20);
  const MapData vulkan = baked(map, "distance_field", {}, "vulkan"),
                opengl = baked(map, "distance_field", {}, "opengl");
  EXPECT_EQ(vulkan.texels, opengl.texels);
  EXPECT_EQ(vulkan.depth, 32);
}

TEST(CertifyDistanceField, OverLevelGroundTheDistanceIsTheHeightAboveIt) {
  const MapData field = baked(constant_map(8, 8, 0.25), "distance_field", {{"distance_field.layers", 16}});
  for (int layer = 0; layer < 16; ++layer) {
    EXPECT_NEAR(field.texels[index_of(field, 3, 5, layer)], std::max(0.0, (layer + 0.5) / 16 - 0.25), 2e-6);
  }
}

/// The wall is 1/16 wide a texel, so at scale 1/4 a texel sideways is 1/4 of H. Its box begins at the centre before it.
TEST(CertifyDistanceField, BesideAWallItIsTheWayToTheWall) {
  const HeightMap map = wall_map(16, 16);  // the column 8
  const MapData field = baked(map, "distance_field", {{"distance_field.layers", 32}, {"distance_field.scale", 0.25}});
  EXPECT_NEAR(field.texels[index_of(field, 6, 3, 31)], 0.25, 1e-5);
  EXPECT_NEAR(field.texels[index_of(field, 5, 3, 31)], 0.5, 1e-5);
  EXPECT_NEAR(field.texels[index_of(field, 1, 3, 31)], 31.5 / 32, 1e-5) << "the base is nearer";
}

TEST(CertifyDistanceField, AnyDistanceThatIsTooLongIsCaught) {
  const HeightMap map = with_address(smooth_noise_map(7, 13), AddressMode::mirror);
  const Values values = {{"distance_field.layers", 8}, {"distance_field.scale", 2}};
  const MapData good = baked(map, "distance_field", values);
  for (std::size_t i = 0; i < good.texels.size(); ++i) {
    MapData faulty = good;
    faulty.texels.set(i, good.texels[i] + 0.2f);  // a texel is 1/26 wide: boxes of cells leave less
    const Certificate certificate = certified_field(map, faulty, values);
    ASSERT_EQ(certificate.violations, 1U);
    EXPECT_EQ(index_of(good, certificate.x, certificate.y, certificate.layer), i);
    EXPECT_LE(certificate.worst, 0.2 + 1e-6);
  }
}

/// The distance to a plane is known: the certifier allows it and nothing more.
TEST(CertifyDistanceField, TheCertifierKnowsTheDistanceToASlope) {
  const HeightMap map = with_address(make_map(64, 8, [](int i, int) { return i / 63.0; }), AddressMode::clamp);
  const Values values = {{"distance_field.layers", 64}, {"distance_field.scale", 1}};
  MapData field = baked(map, "distance_field", values);
  const double drop = (48 + 0.5) / 64 - 20 / 63.0, rise = 64.0 / 63;  // H per longer side
  const double distance = drop / std::sqrt(1 + rise * rise);
  const std::size_t stored = index_of(field, 20, 4, 48);
  EXPECT_LE(field.texels[stored], distance);
  EXPECT_GT(field.texels[stored], distance - 0.02) << "a cell rises by 1/63";
  field.texels.set(stored, static_cast<float>(distance - 1e-5));
  EXPECT_EQ(certified_field(map, field, values).violations, 0U);
  field.texels.set(stored, static_cast<float>(distance + 1e-4));
  EXPECT_EQ(certified_field(map, field, values).violations, 1U);
}

TEST(CertifyDistanceField, OtherLayersThanAskedForAreAnError) {
  const HeightMap map = constant_map(4, 4, 0.5);
  const Result<Certificate> certificate =
      certify(map, baked(map, "distance_field", {{"distance_field.layers", 8}}), {});
  ASSERT_FALSE(certificate);
  EXPECT_EQ(certificate.error().id, "certify.shape");
}

/// What the techniques conclude from the map between its voxels, by both filters: with a tiny shortest step they rely
/// on nothing but it.
TEST(CertifyDistanceField, SpheresPassOverNothingWiderThanTheShortestStep) {
  const HeightMap map = smooth_noise_map(33, 20);
  Random random(3);
  std::vector<Ray> rays;
  for (int i = 0; i < 4000; ++i)
    rays.push_back(slanted(random.uniform(), random.uniform(), random.uniform(0, 6.28), random.uniform(5, 80), 0.1));
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  for (HeightFilter filter : {HeightFilter::exact, HeightFilter::hardware}) {
    const auto hits =
        trace_on("vulkan", map, rays,
                 request_of("sphere_tracing",
                            {{"sphere_tracing.minimum_step", 0.002}, {"sphere_tracing.sphere_steps", 65536}}, filter));
    int late = 0, judged = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (truth[i].ambiguous || truth[i].status != HitStatus::hit) continue;
      ++judged;
      late += hits[i].status != HitStatus::hit || std::abs(hits[i].t - truth[i].t) > 0.02;
    }
    EXPECT_GT(judged, 3500);
    EXPECT_LE(late, filter == HeightFilter::exact ? 0 : 2) << to_string(filter);
  }
}

}  // namespace
}  // namespace relievo::test
