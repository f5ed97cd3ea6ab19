/// Techniques on pyramids and on dilation and erosion maps: what they pass over holds no hit, with every border and at
/// every size, and the two forms of the pyramid are one technique.
#include "support/certify.hpp"
#include "support/linear_claims.hpp"

namespace relievo::test {
namespace {

/// White noise, the steepest there is, at awkward sizes.
std::vector<HeightMap> awkward_maps() {
  std::vector<HeightMap> maps;
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(1, 9), std::pair(9, 1), std::pair(7, 13), std::pair(33, 20)}) {
    for (const AddressMode mode : all_address_modes) maps.push_back(with_address(white_noise_map(width, height), mode));
  }
  return maps;
}

std::string title(const HeightMap& map) {
  return std::to_string(map.width) + "x" + std::to_string(map.height) + " " + std::string(to_string(map.address));
}

std::vector<Hit> trace_with(const HeightMap& map, const std::vector<Ray>& rays, const TraceRequest& request,
                            MapSet maps) {
  const auto traced = trace(backend("vulkan"), registry(), maps, rays, {&request, 1});
  EXPECT_TRUE(traced) << (traced ? "" : format(traced.error())) << title(map);
  return traced ? traced->front().hits : std::vector<Hit>(rays.size());
}

/// So fine where the surface may be that hardly anything is stepped over: what is wrong then was passed over.
TraceRequest fine_request(const std::string& technique, int bits = 32) {
  if (technique == "dilation_erosion")
    return request_of(technique, {{"dilation_erosion.step", 0.02}, {"dilation_erosion.bits", bits}});
  const std::string map = technique == "pyramid" ? "max_pyramid" : technique;
  return request_of(
      technique, {{technique + ".filter_reach", 0.01}, {technique + ".crossing_offset", 0.001}, {map + ".bits", bits}});
}

const std::vector<std::string> layered = {"pyramid", "pyramid_3d", "dilation_erosion"};

TEST(Layered, WhatIsPassedOverHoldsNoHit) {
  for (const std::string& technique : layered) {
    std::uint64_t judged = 0, wrong = 0, exhausted = 0, seed = 1;
    for (const HeightMap& map : awkward_maps()) {
      const std::vector<Ray> rays = bounded_rays(map, 300, seed++);
      const std::vector<Hit> truth = Oracle(map).trace(rays);
      const auto figures =
          compare_hits(truth, trace_with(map, rays, fine_request(technique), map_set(map)), map.width, map.height);
      EXPECT_LE(figures.wrong_percent(), 1.0) << technique << " on " << title(map);
      judged += figures.judged;
      wrong += figures.missed + figures.false_hit + figures.wrong_layer;
      exhausted += figures.exhausted;
    }
    EXPECT_GT(judged, 5000U) << technique;
    EXPECT_LT(100.0 * static_cast<double>(wrong) / static_cast<double>(judged), 0.3) << technique;
    EXPECT_EQ(exhausted, 0U) << technique;
  }
}

TEST(Layered, RoundedMapsHideNoHitEither) {
  const HeightMap map = smooth_noise_map(33, 20);
  const std::vector<Ray> rays = bounded_rays(map, 1000, 5);
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  for (const std::string& technique : layered) {
    for (const int bits : {8, 16}) {
      const auto hits = trace_with(map, rays, fine_request(technique, bits), map_set(map));
      EXPECT_LE(compare_hits(truth, hits, map.width, map.height).wrong_percent(), 0.2) << technique << " " << bits;
    }
  }
}

TEST(Layered, TheSameFiguresCatchAMapThatPassesOverHits) {
  const HeightMap map = white_noise_map(33, 20);
  const std::vector<Ray> rays = bounded_rays(map, 1000, 5);
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  for (const std::string& technique : layered) {
    const std::string name = technique == "pyramid" ? "max_pyramid" : technique;
    MapSet maps = map_set(map);
    maps[name] = baked(map, name);
    MapTexels& texels = maps[name].texels;
    for (std::size_t i = 0; i < texels.size(); ++i) texels.set(i, std::max(texels[i] - 0.1f, 0.0f));
    const auto hits = trace_with(map, rays, fine_request(technique), maps);
    EXPECT_GT(compare_hits(truth, hits, map.width, map.height).wrong_percent(), 5) << technique;
  }
}

TEST(Layered, BothFormsOfThePyramidFindTheSame) {
  for (const HeightMap& map : awkward_maps()) {
    if (std::min(map.width, map.height) == 1) continue;  // there the 3D form leaves out the coarsest levels
    const std::vector<Ray> rays = bounded_rays(map, 300, 9);
    const auto mipmaps = trace_on("vulkan", map, rays, request_of("pyramid")),
               packed = trace_on("vulkan", map, rays, request_of("pyramid_3d"));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(mipmaps[i].status, packed[i].status) << title(map) << " " << describe(rays[i]);
      ASSERT_EQ(mipmaps[i].t, packed[i].t) << title(map) << " " << describe(rays[i]);
      ASSERT_EQ(mipmaps[i].fetches, packed[i].fetches) << title(map) << " " << describe(rays[i]);
    }
  }
}

TEST(Layered, ARayOutOfStepsIsExhaustedAndNoHit) {
  const HeightMap map = white_noise_map(33, 20);
  const std::vector<Ray> rays = make_view_rays(20, 0.1, 16, 16);
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  for (const std::string& technique : layered) {
    const auto hits = trace_on("vulkan", map, rays, request_of(technique, {{technique + ".max_steps", 1}}));
    int exhausted = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_NE(hits[i].status, HitStatus::hit) << technique << " " << describe(rays[i]);
      EXPECT_FALSE(hits[i].status == HitStatus::miss && is_hit(truth[i])) << technique << " " << describe(rays[i]);
      exhausted += hits[i].status == HitStatus::exhausted;
    }
    EXPECT_GT(exhausted, 0) << technique;
  }
}

}  // namespace
}  // namespace relievo::test
