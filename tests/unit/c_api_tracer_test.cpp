/// Rays through the C API: what techniques find on a backend, and the oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "relievo.h"
#include "support/pipeline.hpp"

namespace relievo {

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

class CApiTracer : public ::testing::Test {
 protected:
  static constexpr int width = 24, height = 17;

  CApiTracer() {
    relievo_registry_load(nullptr, 0, &registry_, nullptr);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x)
        heights_.push_back(0.5f + 0.4f * static_cast<float>(std::sin(0.9 * x) * std::cos(0.7 * y)));
    }
    desc_.technique = "exact";
    desc_.backend = "oracle";
    desc_.heights = heights_.data();
    desc_.width = width;
    desc_.height = height;
  }
  ~CApiTracer() override { relievo_registry_free(registry_); }

  /// Rays that floats hold, from the lid down.
  static std::vector<relievo_ray> random_rays(std::size_t count, unsigned seed = 7) {
    std::mt19937 random(seed);
    const auto whole = [&](int least, int most) { return std::uniform_int_distribution(least, most)(random); };
    std::vector<relievo_ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
      rays.push_back({whole(-512, 512) / 256.0, whole(-512, 512) / 256.0, 1, whole(-64, 64) / 64.0,
                      whole(-64, 64) / 64.0, -whole(8, 128) / 32.0, no_limit});
    }
    return rays;
  }

  std::vector<relievo_hit> trace(const char* backend, const std::vector<relievo_ray>& rays) {
    std::vector<relievo_hit> hits(rays.size());
    relievo_tracer* tracer = nullptr;
    relievo_error error{};
    desc_.backend = backend;
    EXPECT_EQ(relievo_tracer_create(registry_, &desc_, &tracer, &error), RELIEVO_OK) << error.message;
    EXPECT_EQ(relievo_tracer_trace(tracer, rays.data(), rays.size(), hits.data(), &error), RELIEVO_OK) << error.message;
    relievo_tracer_free(tracer);
    return hits;
  }

  /// What the C++ API finds with the technique "exact", or the oracle.
  std::vector<Hit> trace_in_cpp(const std::string& backend, const std::vector<relievo_ray>& rays) const {
    HeightMap map;
    map.width = width;
    map.height = height;
    map.texels = heights_;
    std::vector<Ray> given;
    for (const relievo_ray& ray : rays) given.push_back({ray.u, ray.v, ray.h, ray.du, ray.dv, ray.dh, ray.t_max});
    if (backend == "oracle") return Oracle(map).trace(given);
    return test::trace_on(backend, map, given, test::request_of("exact"));
  }

  static void expect_same(const relievo_hit& hit, const Hit& expected) {
    EXPECT_EQ(hit.status, static_cast<relievo_hit_status>(expected.status));
    EXPECT_EQ(hit.ambiguous != 0, expected.ambiguous);
    EXPECT_EQ(hit.t, expected.t);
    EXPECT_EQ(hit.u, expected.u);
    EXPECT_EQ(hit.v, expected.v);
    EXPECT_EQ(hit.h, expected.h);
    EXPECT_EQ(hit.steps, expected.steps);
    EXPECT_EQ(hit.fetches, expected.fetches);
  }

  std::string id_of_creating() {
    relievo_tracer* tracer = nullptr;
    relievo_error error{};
    EXPECT_EQ(relievo_tracer_create(registry_, &desc_, &tracer, &error), error.code);
    EXPECT_EQ(tracer != nullptr, error.code == RELIEVO_OK);
    relievo_tracer_free(tracer);
    return error.id;
  }

  relievo_registry* registry_ = nullptr;
  std::vector<float> heights_;
  relievo_trace_desc desc_{};
};

TEST_F(CApiTracer, AnExactTechniqueFindsWhatTheOracleFinds) {
  const std::vector<relievo_ray> rays = random_rays(2000);
  const std::vector<relievo_hit> truth = trace("oracle", rays);
  for (const char* backend : {"vulkan", "opengl"}) {
    const std::vector<relievo_hit> hits = trace(backend, rays);
    int judged = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (truth[i].ambiguous) continue;
      ++judged;
      ASSERT_EQ(hits[i].status, truth[i].status) << backend << " ray " << i;
      EXPECT_NEAR(hits[i].t, truth[i].t, 1e-5) << backend << " ray " << i;
      EXPECT_NEAR(hits[i].u, rays[i].u + truth[i].t * rays[i].du, 1e-5) << backend << " ray " << i;
      EXPECT_NEAR(hits[i].h, truth[i].h, 1e-5) << backend << " ray " << i;
      EXPECT_GT(hits[i].steps, 0u);
    }
    EXPECT_GT(judged, 1900) << backend;
  }
}

TEST_F(CApiTracer, ParametersAndFilterReachTheTechnique) {
  const std::vector<relievo_ray> rays = random_rays(64);
  desc_.technique = "linear_search";
  relievo_value value{"linear_search.steps", 4};
  desc_.values = &value;
  desc_.value_count = 1;
  for (const relievo_hit& hit : trace("vulkan", rays)) EXPECT_LE(hit.steps, 5u);
  value.value = 300;
  const std::vector<relievo_hit> exact = trace("vulkan", rays);
  desc_.filter = RELIEVO_HARDWARE;
  const std::vector<relievo_hit> filtered = trace("vulkan", rays);
  std::uint32_t most = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    most = std::max(most, exact[i].steps);
    EXPECT_LT(filtered[i].fetches, exact[i].fetches);
  }
  EXPECT_GT(most, 5u);
}

TEST_F(CApiTracer, ThreadsShareATracer) {
  std::vector<std::vector<relievo_ray>> rays;
  for (unsigned seed = 1; seed <= 4; ++seed) rays.push_back(random_rays(500, seed));
  for (const char* backend : {"oracle", "vulkan", "opengl"}) {
    desc_.backend = backend;
    relievo_tracer* tracer = nullptr;
    ASSERT_EQ(relievo_tracer_create(registry_, &desc_, &tracer, nullptr), RELIEVO_OK);
    std::vector<std::vector<relievo_hit>> hits(rays.size(), std::vector<relievo_hit>(rays[0].size()));
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      threads.emplace_back([&, k] {
        EXPECT_EQ(relievo_tracer_trace(tracer, rays[k].data(), rays[k].size(), hits[k].data(), nullptr), RELIEVO_OK);
      });
    }
    for (std::thread& thread : threads) thread.join();
    relievo_tracer_free(tracer);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const std::vector<Hit> expected = trace_in_cpp(backend, rays[k]);
      for (std::size_t i = 0; i < expected.size() && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << backend << ", thread " << k << ", ray " << i);
        expect_same(hits[k][i], expected[i]);
      }
    }
  }
}

TEST_F(CApiTracer, NoRaysAreNoError) {
  relievo_tracer* tracer = nullptr;
  ASSERT_EQ(relievo_tracer_create(registry_, &desc_, &tracer, nullptr), RELIEVO_OK);
  EXPECT_EQ(relievo_tracer_trace(tracer, nullptr, 0, nullptr, nullptr), RELIEVO_OK);
  relievo_tracer_free(tracer);
}

TEST_F(CApiTracer, RaysThatAreNotFiniteMiss) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<relievo_ray> rays{{nan, 0, 1, 0, 0, -1, no_limit},
                                      {0, 0, 1, 0, no_limit, -1, no_limit},
                                      {0, 0, 1, 0, 0, 0, no_limit},
                                      {0, 0, 1, 0, 0, -1, nan},
                                      {1e300, 0, 1, 0, 0, -1e300, 1}};  // finite
  for (const char* backend : {"oracle", "vulkan", "opengl"}) {
    const std::vector<relievo_hit> hits = trace(backend, rays);
    for (std::size_t i = 0; i + 1 < rays.size(); ++i) {
      EXPECT_EQ(hits[i].status, RELIEVO_MISS) << backend << " ray " << i;
      EXPECT_EQ(hits[i].t, 0) << backend << " ray " << i;
    }
    EXPECT_TRUE(hits.back().status >= RELIEVO_MISS && hits.back().status <= RELIEVO_OUTSIDE) << backend;
    EXPECT_TRUE(std::isfinite(hits.back().t)) << backend;
  }
}

TEST_F(CApiTracer, WhatIsWrongIsSaidWhenItIsMade) {
  relievo_value value{"exact.max_stepz", 1};
  desc_.backend = "vulkan";
  EXPECT_EQ(id_of_creating(), "");
  desc_.technique = nullptr;
  EXPECT_EQ(id_of_creating(), "c.null");
  desc_.technique = "exakt";
  EXPECT_EQ(id_of_creating(), "describe.unknown-technique");
  desc_.technique = "exact";
  desc_.values = &value;
  desc_.value_count = 1;
  EXPECT_EQ(id_of_creating(), "c.parameter");
  value = {"exact.max_steps", -3};
  EXPECT_EQ(id_of_creating(), "compose.range");
  desc_.value_count = 0;
  desc_.filter = 9;
  EXPECT_EQ(id_of_creating(), "c.enum");
  desc_.filter = RELIEVO_EXACT;
  desc_.backend = "direct3d";
  EXPECT_EQ(id_of_creating(), "backend.unknown");
  desc_.backend = "vulkan";
  heights_[30] = -0.5f;
  EXPECT_EQ(id_of_creating(), "c.height");
  desc_.width = 1 << 20;
  EXPECT_EQ(id_of_creating(), "c.extent");
}

}  // namespace

}  // namespace relievo
