/// `trace` on both backends: against the oracle, against each other, and on the rays that break ray tracers.
#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "support/linear_claims.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// So many that a step over three map widths is under a quarter of a texel on the widest of the small maps (33).
constexpr int fine_steps = 512;

/// Those that promise the first hit always.
constexpr const char* exact_techniques[] = {"exact", "quadrant_maxima", "robust_cone", "directional_cone"};

TraceRequest fine_search() {
  return request_of("linear_search", {{"linear_search.steps", fine_steps}});
}

/// All small maps with repeat, and some with every other address mode.
std::vector<NamedMap> map_cases() {
  std::vector<NamedMap> cases = small_maps();
  for (const NamedMap& base : small_maps()) {
    if (base.name != "7x13" && base.name != "1x9" && base.name != "plateau" && base.name != "smooth noise") continue;
    for (AddressMode mode : {AddressMode::mirror, AddressMode::clamp, AddressMode::clip})
      cases.push_back({base.name + " " + std::string(to_string(mode)), with_address(base.map, mode)});
  }
  return cases;
}

void expect_finite(const std::vector<Hit>& hits) {
  for (const Hit& hit : hits) {
    ASSERT_TRUE(std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v) && std::isfinite(hit.h))
        << describe(hit);
  }
}

/// Equal, or within 1e-5: both drivers run the same SPIR-V or what was made of it, in float.
bool agree(const Hit& a, const Hit& b) {
  const auto near = [](double x, double y) {
    return std::abs(x - y) <= 1e-5 * std::max({1.0, std::abs(x), std::abs(y)});
  };
  return a.status == b.status && near(a.t, b.t) && near(a.u, b.u) && near(a.v, b.v) && near(a.h, b.h);
}

/// Hits of one ray on Vulkan and OpenGL; the two must agree.
Hit trace_one(const HeightMap& map, const Ray& ray, const TraceRequest& request = fine_search()) {
  const Hit vulkan = trace_on("vulkan", map, {ray}, request)[0], opengl = trace_on("opengl", map, {ray}, request)[0];
  EXPECT_TRUE(agree(vulkan, opengl)) << describe(ray) << ": " << describe(vulkan) << " and " << describe(opengl);
  return vulkan;
}

TEST(Trace, AFineLinearSearchFindsEveryFirstHitThatLastsAStep) {
  int certain = 0;
  for (const std::string& name : both_backends) {
    std::uint64_t seed = 1;
    for (const auto& [title, map] : map_cases()) {
      const std::vector<Ray> rays = bounded_rays(map, 200, seed++);
      const std::vector<Hit> truth = Oracle(map).trace(rays), hits = trace_on(name, map, rays, fine_search());
      expect_finite(hits);
      const SearchVerdict verdict = judge_search(map, rays, truth, hits, fine_steps);
      EXPECT_EQ(verdict.found, verdict.certain) << title << " on " << name << ": " << verdict.first_fault;
      EXPECT_EQ(verdict.false_hits, 0) << title << " on " << name << ": " << verdict.first_fault;
      certain += verdict.certain;
    }
  }
  EXPECT_GT(certain, 3000) << "too few rays are judged for the figures above to mean anything";
}

/// Missed, false, wrong and exhausted ones, by all techniques that promise the first hit, on both backends.
/// With `max_steps` instead of the techniques' own, if it is given.
void expect_all_found(const HeightMap& map, const std::vector<Ray>& rays, std::size_t least_judged,
                      std::optional<int> max_steps = {}) {
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  for (const std::string& name : both_backends) {
    for (const std::string technique : exact_techniques) {
      TraceRequest request = request_of(technique);
      if (max_steps) request.values[technique + ".max_steps"] = *max_steps;
      const auto hits = trace_on(name, map, rays, request);
      const ErrorFigures error = compare_hits(truth, hits, map.width, map.height);
      EXPECT_EQ(error.exhausted + error.missed + error.false_hit + error.wrong_layer, 0U)
          << technique << " on " << name << ", " << map.width << "x" << map.height;
      EXPECT_GE(error.judged, least_judged);
    }
  }
}

/// Beyond the edge cells are all the same along an axis; along the other, a ray may take tens of tiles to leave one.
TEST(Trace, ExactTechniquesCrossWhatLiesBeyondTheEdgeInFewSteps) {
  constexpr int few = 1500;  // of the 5000 cells that a ray crosses, each a step or three
  for (const auto& [width, height] : {std::pair{256, 16}, std::pair{3, 256}, std::pair{256, 256}}) {
    const HeightMap map = with_address(white_noise_map(width, height), AddressMode::clamp);
    std::vector<Ray> rays;
    for (int i = 0; i < 400; ++i) {
      const double heading = 0.0157 * i, du = std::cos(heading), dv = std::sin(heading), h = 0.0025 * i;
      rays.push_back({0.5 - 20 * du, 0.5 + 0.001 * i - 20 * dv, h, du, dv, i % 2 ? 0 : -0.001, 20});
    }
    expect_all_found(map, rays, 381, few);
  }
}

/// It sinks in by 1.5e-5 of H within 1e-4 texel of a corner of the map, 900 equal cells beyond both edges.
TEST(Trace, AHairOfACellAtTheCornerOfAClampedMapIsFoundFromAfar) {
  const HeightMap map{
      3, 3, {0.593000889f, 0, 0.458329499f, 1, 0.528607845f, 1, 0.520209908f, 0, 0.782574773f}, AddressMode::clamp};
  const Ray ray{-302.100372f, -203.169891f, 0.593012214f, 0.276576877f, 0.186054677f, 8.40432113e-10f};
  expect_all_found(map, {ray}, 1);
}

/// They come to a border of cells in no time that floats tell, and stay there.
TEST(Trace, RaysAHairOffAGridLineAreNotExhausted) {
  for (const AddressMode mode : {AddressMode::repeat, AddressMode::mirror, AddressMode::clamp, AddressMode::clip}) {
    HeightMap map{4, 4, std::vector<float>(16, 0.25f), mode};
    map.texels[5] = 0.9f;
    std::vector<Ray> rays;
    for (const double across : {-1e-9, 1e-9, -6e-17, 6e-17}) {
      for (const double along : {-1., 1.}) {
        for (int texel = 0; texel < 4; ++texel) {
          rays.push_back({0.125 + 0.25 * texel, 0.125, 0.95, along, across, -0.001});
          rays.push_back({0.125, 0.125 + 0.25 * texel, 0.95, across, along, -0.001});
        }
      }
    }
    expect_all_found(map, rays, rays.size() / 2);
  }
}

TEST(Trace, TheSameJudgementCatchesSeededFaults) {
  const HeightMap map = smooth_noise_map(33, 20);
  const std::vector<Ray> rays = bounded_rays(map, 400, 7);
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  HeightMap shifted = map, raised = map, lowered = map;
  std::rotate(shifted.texels.begin(), shifted.texels.begin() + 1, shifted.texels.end());
  for (float& t : raised.texels) t = std::min(t + 2.0f / 255.0f, 1.0f);
  for (float& t : lowered.texels) t = std::max(t - 2.0f / 255.0f, 0.0f);
  for (const HeightMap& faulty : {shifted, raised, lowered}) {
    const auto hits = trace_on("vulkan", faulty, rays, fine_search());
    const SearchVerdict verdict = judge_search(map, rays, truth, hits, fine_steps);
    EXPECT_GT(verdict.false_hits + verdict.certain - verdict.found, 10);
  }
  std::vector<Hit> swapped = trace_on("vulkan", map, rays, fine_search());
  const SearchVerdict good = judge_search(map, rays, truth, swapped, fine_steps);
  EXPECT_EQ(good.false_hits + good.certain - good.found, 0) << good.first_fault;
  std::rotate(swapped.begin(), swapped.begin() + 1, swapped.end());
  const SearchVerdict verdict = judge_search(map, rays, truth, swapped, fine_steps);
  EXPECT_GT(verdict.false_hits + verdict.certain - verdict.found, 50) << "hits in another order";
}

TEST(Trace, BothBackendsAgreeOnEveryTechnique) {
  const HeightMap map = smooth_noise_map(33, 20);
  const std::vector<Ray> rays = bounded_rays(map, 2000, 11);
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  for (const std::string& technique : technique_names()) {
    const auto vulkan = trace_on("vulkan", map, rays, request_of(technique));
    const auto opengl = trace_on("opengl", map, rays, request_of(technique));
    expect_finite(vulkan);
    expect_finite(opengl);
    std::size_t judged = 0, same = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (truth[i].ambiguous) continue;
      ++judged;
      same += agree(vulkan[i], opengl[i]);
    }
    EXPECT_GT(judged, 1500U);
    EXPECT_EQ(same, judged) << technique;
  }
}

TEST(Trace, ThreeRunsAreByteIdentical) {
  const HeightMap map = white_noise_map(16, 16);
  const std::vector<Ray> rays = bounded_rays(map, 500, 5);
  for (const std::string& name : both_backends) {
    for (const std::string& technique : technique_names()) {
      MapSet maps = map_set(map);
      const TraceRequest request = request_of(technique);
      for (const std::string& needed : registry().techniques.at(technique).maps)
        ASSERT_TRUE(bake_map(backend(name), registry(), needed, maps));
      const auto job = make_trace_job(registry(), maps, rays, {&request, 1}, backend(name).info().shader_target);
      ASSERT_TRUE(job) << format(job.error());
      const auto first = backend(name).execute(*job);
      ASSERT_TRUE(first) << format(first.error());
      for (int run = 0; run < 2; ++run) {
        const auto again = backend(name).execute(*job);
        ASSERT_TRUE(again) << format(again.error());
        EXPECT_EQ(again->read_backs, first->read_backs) << technique << " on " << name;
      }
    }
  }
}

TEST(Trace, AVerticalRayHitsTheHeightBelowIt) {
  const HeightMap map = white_noise_map(7, 13);
  for (const auto& [u, v] : {std::pair(0.5, 0.5), std::pair(0.1, 0.93), std::pair(0.0, 0.0)}) {
    const Hit hit = trace_one(map, {u, v, 1, 0, 0, -1});
    EXPECT_EQ(hit.status, HitStatus::hit);
    EXPECT_LE(hit.h, sample_height(map, u, v) + 1e-6);
    EXPECT_GE(hit.h, sample_height(map, u, v) - 1.0 / fine_steps - 1e-6) << "more than a step too deep";
    EXPECT_EQ(hit.u, u == 0.1 ? double(0.1f) : u);
  }
}

TEST(Trace, AHorizontalRayWithinTheSlabHitsTheWall) {
  const HeightMap map = wall_map(16, 16);  // the column 8 is 1; its ramps begin at the centres of 7 and 9
  const Hit hit = trace_one(map, {0.25, 0.5, 0.5, 1, 0, 0, 1});
  EXPECT_EQ(hit.status, HitStatus::hit);
  EXPECT_NEAR(hit.u, 0.5, 1.0 / fine_steps + 1e-6);
  EXPECT_NEAR(hit.h, 0.5, 1e-6);
}

TEST(Trace, AHorizontalRayWithoutEndThatMeetsNothingIsExhaustedAndNoHit) {
  const Hit hit = trace_one(constant_map(8, 8, 0.25), {0.25, 0.5, 0.5, 1, 0, 0});
  EXPECT_EQ(hit.status, HitStatus::exhausted);
  EXPECT_TRUE(std::isfinite(hit.t) && std::isfinite(hit.u));
}

TEST(Trace, ARayAboveTheLidEntersThere) {
  const HeightMap map = constant_map(8, 8, 0.5);
  const Hit hit = trace_one(map, {0.25, 0.25, 3, 0.125, 0, -1});
  EXPECT_EQ(hit.status, HitStatus::hit);
  EXPECT_NEAR(hit.t, 2.5, 1.0 / fine_steps);
  EXPECT_NEAR(hit.u, 0.25 + 2.5 / 8, 1.0 / fine_steps);
  EXPECT_EQ(trace_one(map, {0.25, 0.25, 3, 0.125, 0, 1}).status, HitStatus::miss) << "rises away";
  EXPECT_EQ(trace_one(map, {0.25, 0.25, 3, 0.125, 0, 0}).status, HitStatus::miss) << "never comes down";
  EXPECT_EQ(trace_one(map, {0.25, 0.25, 3, 0.125, 0, -1, 1.5}).status, HitStatus::miss) << "ends above the lid";
}

TEST(Trace, ARayFromFarAboveEntersTheLidWhereItDoes) {
  // With t in one float it would enter on a plateau that it passes by.
  const HeightMap map = with_address(plateau_map(31, 44), AddressMode::mirror);
  const Ray ray = {-51.13052099943161, 39.561673998832703, 43.9619484, 0.788251221, -0.615352452, -0.0115631092};
  const Hit truth = Oracle(map).trace(ray);
  for (const char* technique : exact_techniques) {
    const Hit hit = trace_one(map, ray, request_of(technique));
    EXPECT_EQ(hit.status, HitStatus::hit) << technique;
    EXPECT_NEAR(hit.t, truth.t, 0.01) << technique;
    EXPECT_NEAR(hit.h, truth.h, 1e-5) << technique;
  }
}

TEST(Trace, AHitThousandsOfTilesAwayKeepsItsPlace) {
  // A float (u, v) of 2000 tiles is a hundredth of a texel of this map, or two, off.
  std::vector<Ray> rays;
  for (int i = 0; i < 32; ++i) {
    const float turn = 0.2f * static_cast<float>(i);
    rays.push_back({0.3, 0.6, 20.0 + i, std::cos(turn), std::sin(turn), -0.0174532924});
    rays.push_back({0.015625, 0.0078125, 20.0 + i, 1.0 - i % 2, 0.0 + i % 2, -0.0174532924});  // along a trench
  }
  for (const AddressMode mode : {AddressMode::repeat, AddressMode::mirror, AddressMode::clamp}) {
    const HeightMap map = with_address(plateau_map(31, 44), mode);
    const std::vector<Hit> truth = Oracle(map).trace(rays);
    EXPECT_TRUE(std::any_of(truth.begin(), truth.end(), [](const Hit& hit) { return hit.h < 1e-12; }));
    for (const std::string& name : both_backends) {
      for (const char* technique : exact_techniques) {
        const ErrorFigures figures = compare_hits(truth, trace_on(name, map, rays, request_of(technique)), 31, 44);
        EXPECT_GE(figures.judged, 32u);
        EXPECT_EQ(figures.wrong_percent() + figures.percent(figures.exhausted), 0) << technique << " on " << name;
        EXPECT_LT(figures.uv_texels.max, 5e-4) << technique << " on " << name << ", " << to_string(mode);
      }
    }
  }
}

TEST(Trace, AWalkThatStartsAnewManyTimesDoesNotDrift) {
  // From the lid to the base in 400 tiles of 2048 texels; what one float of height loses at a start is then 0.02 texel.
  const HeightMap map = constant_map(2048, 3, 0);
  std::vector<Ray> rays;
  for (int i = 0; i < 16; ++i) {
    const float turn = 0.39f * static_cast<float>(i);
    rays.push_back({0.3, 0.6, 1, std::cos(turn), std::sin(turn), -0.002223729155957699});
  }
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  for (const char* technique : exact_techniques) {
    const std::string budget = std::string(technique) + ".max_steps";
    const auto hits = trace_on("vulkan", map, rays, request_of(technique, {{budget, 65536}}));
    const ErrorFigures figures = compare_hits(truth, hits, 2048, 3);
    EXPECT_EQ(figures.judged, rays.size()) << technique;
    EXPECT_EQ(figures.wrong_percent() + figures.percent(figures.exhausted), 0) << technique;
    EXPECT_LT(figures.uv_texels.max, 2e-3) << technique;
  }
}

TEST(Trace, ARayFromMilesAboveMeetsWhatIsLowToo) {
  // t of lid and base differ by a few roundings; heights that are met on the way count all the same.
  const HeightMap map = constant_map(5, 4, 0.003f);
  const Ray ray = {0.25, 0.25, 1e5, 0.3f, 0, -0.3f};
  for (const char* technique : exact_techniques) {
    const Hit hit = trace_one(map, ray, request_of(technique));
    EXPECT_EQ(hit.status, HitStatus::hit) << technique;
    EXPECT_NEAR(hit.h, 0.003, 1e-6) << technique;
  }
}

TEST(Trace, APlateauAtTheLidIsTouched) {
  const HeightMap map = constant_map(8, 8, 1);
  for (const double height : {1.0, 1.7}) {
    for (const char* technique : {"linear_search", "relief", "parallax_occlusion"}) {
      const Hit hit = trace_one(map, {0.3, 0.6, height, 0.7, 0.1, -1}, request_of(technique));
      EXPECT_EQ(hit.status, HitStatus::hit) << technique;
      EXPECT_NEAR(hit.h, 1, 1e-6) << technique;
      EXPECT_NEAR(hit.t, height - 1, 1e-6) << technique;
    }
  }
}

TEST(Trace, AFlatBaseIsHitAtTheBase) {
  for (const std::string& technique : technique_names()) {
    const Hit hit = trace_one(constant_map(5, 3, 0), {0.3, 0.6, 1, 0.7, -0.3, -1}, request_of(technique));
    EXPECT_EQ(hit.status, HitStatus::hit) << technique;
    EXPECT_NEAR(hit.t, 1, 0.01) << technique;
    EXPECT_NEAR(hit.h, 0, 0.01) << technique;
  }
}

TEST(Trace, ARayThatStartsBelowTheSurfaceIsInsideAtZero) {
  const Hit hit = trace_one(constant_map(8, 8, 0.5), {0.3, 0.6, 0.25, 1, 0, -1});
  EXPECT_EQ(hit.status, HitStatus::inside);
  EXPECT_EQ(hit.t, 0);
  EXPECT_EQ(trace_one(constant_map(8, 8, 0.5), {0.3, 0.6, -0.25, 1, 0, -1}).status, HitStatus::inside)
      << "under the base";
}

TEST(Trace, AClipMapEndsAtItsDomain) {
  const HeightMap map = with_address(constant_map(8, 8, 0.25), AddressMode::clip);
  EXPECT_EQ(trace_one(map, {0.5, 0.5, 1, 1, 0, -0.5}).status, HitStatus::outside) << "leaves at u = 1, H = 3/4";
  EXPECT_EQ(trace_one(map, {1.5, 0.5, 1, 1, 0, -0.5}).status, HitStatus::outside) << "never enters";
  EXPECT_EQ(trace_one(map, {1.5, 0.5, 1, 0, 0, -1}).status, HitStatus::outside) << "falls beside it";
  const Hit edge = trace_one(map, {-0.5, 0.5, 0.5, 1, 0, -0.75});
  EXPECT_EQ(edge.status, HitStatus::hit) << "enters below the surface: its side";
  EXPECT_NEAR(edge.t, 0.5, 1e-6);
}

TEST(Trace, ALimitBeforeTheHitIsAMissAndOneBehindItIsNot) {
  const HeightMap map = constant_map(8, 8, 0.5);
  Ray ray{0.25, 0.25, 1, 0.5, 0, -1};
  ray.t_max = 0.49;
  const Hit before = trace_one(map, ray);
  EXPECT_EQ(before.status, HitStatus::miss);
  EXPECT_LE(before.t, 0.49 + 1e-6);
  ray.t_max = 0.51;
  EXPECT_EQ(trace_one(map, ray).status, HitStatus::hit);
  ray.t_max = 0;
  EXPECT_EQ(trace_one(map, ray).status, HitStatus::miss);
}

TEST(Trace, WholeTilesOfTheTextureCoordinateChangeNothing) {
  for (const AddressMode mode : {AddressMode::repeat, AddressMode::mirror}) {
    const HeightMap map = with_address(white_noise_map(7, 13), mode);
    std::vector<Ray> near, far;
    Random random(3);
    for (int i = 0; i < 300; ++i) {
      // Dyadic coordinates, so that adding the tiles is exact.
      near.push_back({random.below(1024) / 1024.0, random.below(1024) / 1024.0, 1, random.uniform(-1, 1),
                      random.uniform(-1, 1), -0.5});
      far.push_back(near.back());
      far.back().u += 1e6;
      far.back().v -= 2e6;
    }
    for (const std::string& name : both_backends) {
      const auto a = trace_on(name, map, near, fine_search()), b = trace_on(name, map, far, fine_search());
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].status, b[i].status) << describe(near[i]);
        EXPECT_EQ(a[i].t, b[i].t) << describe(near[i]);
        EXPECT_NEAR(a[i].u, b[i].u - 1e6, 1e-9) << describe(near[i]);
        EXPECT_NEAR(a[i].v, b[i].v + 2e6, 1e-9) << describe(near[i]);
      }
    }
  }
}

TEST(Trace, RaysThatAreNoRaysMissWithFiniteNumbers) {
  std::vector<Ray> rays;
  for (const double bad : {not_a_number, infinity, -infinity}) {
    for (int field = 0; field < 6; ++field) {
      Ray ray{100.25, -70.5, 1, 0.5, 0.25, -1};
      double* fields[] = {&ray.u, &ray.v, &ray.h, &ray.du, &ray.dv, &ray.dh};
      *fields[field] = bad;
      rays.push_back(ray);
    }
  }
  rays.push_back({0.25, 0.25, 1, 0, 0, 0});
  rays.push_back({0.25, 0.25, 1, 0.5, 0, -1, not_a_number});
  rays.push_back({0.25, 0.25, 1, 0.5, 0, -1, -1});
  for (const AddressMode mode : {AddressMode::mirror, AddressMode::clip}) {
    const HeightMap map = with_address(white_noise_map(7, 13), mode);
    for (const std::string& name : both_backends) {
      for (const std::string& technique : technique_names()) {
        const auto hits = trace_on(name, map, rays, request_of(technique));
        expect_finite(hits);
        for (std::size_t i = 0; i < hits.size(); ++i)
          EXPECT_TRUE(hits[i].status == HitStatus::miss && hits[i].t == 0)
              << technique << " on " << name << ": " << describe(rays[i]) << " " << describe(hits[i]);
      }
    }
  }
}

TEST(Trace, ExtremeRaysGiveFiniteNumbers) {
  std::vector<Ray> rays;
  for (const double size : {1e-300, 1e-40, 1e-20, 1e20, 1e37, 1e300}) {
    rays.push_back({0.25, 0.25, 1, size, size, -size});
    rays.push_back({0.25, 0.25, 1, size, 0, -1});
    rays.push_back({0.25, 0.25, 1, 1, 0, -size});
    rays.push_back({0.25, 0.25, 1 + size, 1, 0.5, -1});
    rays.push_back({0.25 + size, 0.25 - size, 1, 1, 0.5, -1});
  }
  for (const std::string& name : both_backends) {
    for (const std::string& technique : technique_names()) {
      const TraceRequest exact = request_of(technique), hardware = request_of(technique, {}, HeightFilter::hardware);
      expect_finite(trace_on(name, with_address(white_noise_map(7, 13), AddressMode::repeat), rays, exact));
      expect_finite(trace_on(name, with_address(white_noise_map(7, 13), AddressMode::clip), rays, hardware));
    }
  }
}

TEST(Trace, HardwareFilteringDiffersByNoMoreThanEightFractionalBitsCost) {
  const HeightMap map = smooth_noise_map(32, 32);
  const std::vector<Ray> rays = make_view_rays(60, 0.1, 64, 64);
  const std::vector<Hit> truth = Oracle(map).trace(rays);
  for (const std::string& name : both_backends) {
    const auto figures = [&](HeightFilter filter) {
      return compare_hits(truth, trace_on(name, map, rays, request_of("relief", {{"relief.binary_steps", 20}}, filter)),
                          map.width, map.height);
    };
    const ErrorFigures exact = figures(HeightFilter::exact), hardware = figures(HeightFilter::hardware);
    EXPECT_EQ(exact.wrong_percent(), 0) << name;
    EXPECT_EQ(exact.non_finite, 0U) << name;
    // Bisection ends at an ulp of t, about 1e-7, and float interpolation adds a few more.
    EXPECT_LT(exact.height.max, 2e-6) << name;
    // A weight that is off by 2^-9 moves the surface by that share of a texel's rise, here at most 0.135, and there is
    // one weight an axis. A hit is moved less than twice as far: the ray falls by 17 a map's width, and the surface
    // rises by 6 at most. Software drivers filter in float, so there may be no difference at all.
    EXPECT_LT(hardware.height.max, 0.135 / 512 * 2 * 2) << name;
    EXPECT_LT(hardware.mean_fetches, exact.mean_fetches / 3) << name << ": one fetch in place of four";
  }
}

}  // namespace
}  // namespace relievo::test
