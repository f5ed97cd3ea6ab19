#include "relievo/oracle.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/hard_rays.hpp"
#include "support/height_maps.hpp"

namespace relievo {
namespace {

using test::describe;
using test::hard_ray;
using test::slanted;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Oracle, HitsAHugelyScaledReliefAfterManyCells) {
  const HeightMap map = test::with_address(test::spike_map(64, 64), AddressMode::repeat);
  const double drop = 1e-4;          // of H per map width: ten thousand widths to the floor
  const double v = (10 + 0.5) / 64;  // clear of the spikes' row
  const Hit hit = Oracle(map).trace({0.3, v, 1, 1, 0, -drop});
  EXPECT_EQ(hit.status, HitStatus::hit);
  EXPECT_NEAR(hit.t, 1 / drop, 1e-8);
}

TEST(Oracle, SeesTheSameAMillionTilesAway) {
  for (const AddressMode mode : {AddressMode::repeat, AddressMode::mirror}) {
    const HeightMap map = test::with_address(test::white_noise_map(7, 13), mode);
    const Oracle oracle(map);
    test::Random random(9);
    for (int i = 0; i < 2000; ++i) {
      Ray near = hard_ray(random, map);
      near.u = std::round(near.u * 0x1p20) * 0x1p-20, near.v = std::round(near.v * 0x1p20) * 0x1p-20;
      Ray far = near;
      far.u += 1e6, far.v -= 1e6;  // exact: 20 + 20 bits; an even number of tiles for the mirror's sake
      const Hit a = oracle.trace(near), b = oracle.trace(far);
      ASSERT_TRUE(a.status == b.status && a.t == b.t && a.h == b.h) << to_string(mode) << ": " << describe(near);
    }
  }
}

TEST(Oracle, ExtendsTheEdgeOfAClampedMapForEver) {
  const HeightMap map = test::with_address(test::ramp_map(9, 9), AddressMode::clamp);
  const Oracle oracle(map);
  EXPECT_EQ(oracle.trace({1e6, 0.5, 1, 1, 0.1, -0.5}).t, 0) << "touches the extended top";
  EXPECT_NEAR(oracle.trace({-1e6, 3e5, 1, -1, 0.1, -0.5}).t, 2, 1e-12) << "falls to the extended floor";
  const Hit back = oracle.trace({-1e6, 0.5, 0.5, 1, 0, 0});
  EXPECT_EQ(back.status, HitStatus::hit);
  EXPECT_NEAR(back.t, 1e6 + 0.5, 1e-8) << "comes from far, horizontally, to the middle of the ramp";
}

TEST(Oracle, DecidesHorizontalRaysThatLeaveAClampedMap) {
  const HeightMap map = test::with_address(test::ramp_map(8, 8), AddressMode::clamp);
  const Hit away = Oracle(map).trace({0.5, 0.5, 0.75, -1, 0.2, 0});
  EXPECT_EQ(away.status, HitStatus::miss);
  EXPECT_TRUE(std::isfinite(away.t));
  EXPECT_LT(away.steps, 30u);
}

TEST(Oracle, ExhaustsHorizontalRaysOverAPeriodicMap) {
  OracleOptions options;
  options.max_cells = 100000;
  const Hit hit = Oracle(test::constant_map(64, 64, 0.5), options).trace({0.1, 0.2, 0.75, 1, 0, 0});
  EXPECT_EQ(hit.status, HitStatus::exhausted);
  EXPECT_NEAR(hit.u * 64, 100000, 64);
}

TEST(Oracle, CrossesExactlyAsManyCellsAsAllowed) {
  const HeightMap map = test::wall_map(64, 64);  // the wall's foot is the cell from texel 31 to 32
  const Ray ray{0.5 / 64, 0.5 / 64, 0.5, 1, 0, 0};
  OracleOptions options;
  options.max_cells = 32;
  EXPECT_EQ(Oracle(map, options).trace(ray).status, HitStatus::hit);
  options.max_cells = 31;
  EXPECT_EQ(Oracle(map, options).trace(ray).status, HitStatus::exhausted);
  options.max_cells = 0;
  EXPECT_EQ(Oracle(map, options).trace(ray).status, HitStatus::exhausted);
}

TEST(Oracle, HitsAPlateauOfExactlyOneFromTheLid) {
  const Oracle oracle(test::constant_map(4, 4, 1));
  for (const Ray& ray : {Ray{0.3, 0.3, 1, 1, 0, -0.01}, Ray{0.3, 0.3, 1, 0, 0, -1}, Ray{0.3, 0.3, 1, 1, 0, 0},
                         Ray{0.3, 0.3, 1, 1, 0, 1}}) {
    const Hit hit = oracle.trace(ray);
    EXPECT_EQ(hit.status, HitStatus::hit) << describe(ray);
    EXPECT_EQ(hit.t, 0) << describe(ray);
    EXPECT_EQ(hit.ambiguous, ray.dh >= 0) << describe(ray);
  }
  const Hit from_above = oracle.trace({0.3, 0.3, 1.7, 0.3, 0.1, -0.3});
  EXPECT_EQ(from_above.status, HitStatus::hit);
  EXPECT_DOUBLE_EQ(from_above.t, 0.7 / 0.3);
}

TEST(Oracle, HitsAFloorOfExactlyZero) {
  const Oracle oracle(test::constant_map(4, 4, 0));
  for (const double slope : {1.0, 0.1, 1.0 / 3, 7e-3}) {
    const Hit hit = oracle.trace({0.3, 0.3, 1, 0.7, 0.1, -slope});
    EXPECT_EQ(hit.status, HitStatus::hit) << slope;
    EXPECT_DOUBLE_EQ(hit.t, 1 / slope);
    EXPECT_NEAR(hit.h, 0, 1e-15);
    EXPECT_FALSE(hit.ambiguous);
  }
}

TEST(Oracle, HitsTheSpikesTipStraightFromAbove) {
  const HeightMap map = test::spike_map(16, 16);
  const Hit tip = Oracle(map).trace({8.5 / 16, 8.5 / 16, 2, 0, 0, -1});
  EXPECT_EQ(tip.status, HitStatus::hit);
  EXPECT_EQ(tip.t, 1);
  const Hit beside = Oracle(map).trace({8.75 / 16, 8.5 / 16, 2, 0, 0, -1});
  EXPECT_DOUBLE_EQ(beside.h, 0.75);
}

TEST(Oracle, HitsAWallThatItTouchesAtItsVeryTop) {
  const Hit hit = Oracle(test::wall_map(16, 16)).trace({0.5 / 16, 0.25, 1, 1, 0, 0, 4.0});
  EXPECT_EQ(hit.status, HitStatus::hit);
  EXPECT_EQ(hit.t, 0.5);
  EXPECT_TRUE(hit.ambiguous);
}

TEST(Oracle, FindsAnExactTangentOnASaddle) {
  // One clip map of 2×2 texels: h = (a + b − 2ab) over the middle cell. Along a = b it is 2a(1 − a), at most 1/2.
  const HeightMap map = test::with_address(test::checker_map(2, 2), AddressMode::clip);
  const Ray tangent{0.25, 0.25, 0.5, 1, 1, 0};
  const Hit touch = Oracle(map).trace(tangent);
  EXPECT_EQ(touch.status, HitStatus::hit);
  EXPECT_EQ(touch.t, 0.25);
  EXPECT_TRUE(touch.ambiguous);
  Ray above = tangent;
  above.h = 0.5 + 1e-9;
  EXPECT_EQ(Oracle(map).trace(above).status, HitStatus::outside);
  EXPECT_TRUE(Oracle(map).trace(above).ambiguous);
  above.h = 0.5 + 2e-5;
  EXPECT_FALSE(Oracle(map).trace(above).ambiguous);
  Ray below = tangent;
  below.h = 0.5 - 1e-9;
  EXPECT_EQ(Oracle(map).trace(below).status, HitStatus::hit);
  EXPECT_TRUE(Oracle(map).trace(below).ambiguous) << "comes out again at once";
  below.h = 0.5 - 2e-5;
  EXPECT_FALSE(Oracle(map).trace(below).ambiguous);
}

TEST(Oracle, CallsARayAmbiguousThatGrazesARidgeBeforeItsHit) {
  const HeightMap map = test::with_address(
      test::make_map(16, 1, [](int i, int) { return i == 4   ? 0.5
                                                    : i == 8 ? 0.75
                                                             : 0; }), AddressMode::clamp);
  const Oracle oracle(map);
  const auto over_ridge = [](double gap) { return Ray{0.5 / 16, 0.5, 0.5 + gap, 1, 0, 0}; };
  EXPECT_TRUE(oracle.trace(over_ridge(5e-6)).ambiguous);
  EXPECT_EQ(oracle.trace(over_ridge(5e-6)).status, HitStatus::hit);
  EXPECT_GT(oracle.trace(over_ridge(5e-6)).t, 7.0 / 16);
  EXPECT_FALSE(oracle.trace(over_ridge(2e-5)).ambiguous);
  EXPECT_FALSE(oracle.trace(over_ridge(-0.1)).ambiguous) << "the approach to a hit is no near pass";
}

TEST(Oracle, ReportsInsideBelowTheSurface) {
  const Oracle oracle(test::constant_map(4, 4, 0.5));
  for (const Ray& ray : {Ray{0.3, 0.3, 0.4, 1, 0, 1}, Ray{0.3, 0.3, 0.4, 1, 0, -1}, Ray{0.3, 0.3, -3, 1, 0, 0},
                         Ray{0.3, 0.3, -3, 0, 0, -1}, Ray{0.3, 0.3, -3, 0, 1, 2}}) {
    const Hit hit = oracle.trace(ray);
    EXPECT_EQ(hit.status, HitStatus::inside) << describe(ray);
    EXPECT_EQ(hit.t, 0);
    EXPECT_EQ(hit.h, ray.h);
    EXPECT_FALSE(hit.ambiguous);
  }
  EXPECT_EQ(oracle.trace({0.3, 0.3, 0.5, 1, 0, -1}).status, HitStatus::hit) << "H = h is a hit at t = 0";
}

TEST(Oracle, MissesWhatLeavesUpwardOrEndsEarly) {
  const Oracle oracle(test::constant_map(4, 4, 0.5));
  const Hit up = oracle.trace({0.3, 0.3, 0.75, 1, 0, 1});
  EXPECT_EQ(up.status, HitStatus::miss);
  EXPECT_DOUBLE_EQ(up.t, 0.25);
  const Hit early = oracle.trace({0.3, 0.3, 1, 1, 0, -1, 0.25});
  EXPECT_EQ(early.status, HitStatus::miss);
  EXPECT_EQ(early.t, 0.25);
  EXPECT_EQ(oracle.trace({0.3, 0.3, 1, 1, 0, -1, 0.5}).status, HitStatus::hit) << "t_max is included";
  EXPECT_EQ(oracle.trace({0.3, 0.3, 3, 1, 0, -1, 1}).status, HitStatus::miss) << "ends above the lid";
  EXPECT_EQ(oracle.trace({0.3, 0.3, 3, 1, 0, 0}).status, HitStatus::miss);
}

TEST(Oracle, TreatsAClipMapAsASolidInItsDomain) {
  const HeightMap map = test::with_address(test::constant_map(4, 4, 0.5), AddressMode::clip);
  const Oracle oracle(map);
  EXPECT_EQ(oracle.trace({0.9, 0.5, 1, 1, 0, -1}).status, HitStatus::outside);
  EXPECT_NEAR(oracle.trace({0.9, 0.5, 1, 1, 0, -1}).t, 0.1, 1e-15);
  const Hit side = oracle.trace({-1, 0.5, 0.25, 1, 0, 0});
  EXPECT_EQ(side.status, HitStatus::hit);
  EXPECT_EQ(side.t, 1);
  EXPECT_FALSE(side.ambiguous);
  const Hit side_from_below = oracle.trace({-1, 0.5, -1, 1, 0, 0.75});
  EXPECT_EQ(side_from_below.status, HitStatus::hit);
  EXPECT_EQ(side_from_below.t, 1) << "below the floor is inside too";
  const Hit over_side = oracle.trace({-1, 0.5, 0.75, 1, 0, -0.125});
  EXPECT_EQ(over_side.status, HitStatus::hit);
  EXPECT_EQ(over_side.t, 2) << "enters over the side, lands at the far corner of the domain";
  EXPECT_EQ(oracle.trace({-1, 0.5, 0.75, 1, 0, 0}).status, HitStatus::outside);
  EXPECT_EQ(oracle.trace({-1, 0.5, 1, -1, 0, -1}).status, HitStatus::outside) << "never comes to the domain";
  EXPECT_EQ(oracle.trace({-1, 0.5, 1, 0, 0, -1}).status, HitStatus::outside);
  EXPECT_EQ(oracle.trace({0.5, 1, 1, 0, 0, -1}).status, HitStatus::hit) << "the domain is closed";
}

TEST(Oracle, MissesRaysThatAreNone) {
  const Oracle oracle(test::constant_map(4, 4, 0.5));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Ray& ray : {Ray{0, 0, 1, 0, 0, 0}, Ray{nan, 0, 1, 0, 0, -1}, Ray{0, infinity, 1, 0, 0, -1},
                         Ray{0, 0, nan, 0, 0, -1}, Ray{0, 0, 1, nan, 0, -1}, Ray{0, 0, 1, 0, -infinity, -1},
                         Ray{0, 0, 1, 0, 0, infinity}, Ray{0, 0, 1, 0, 0, -1, nan}, Ray{0, 0, 1, 0, 0, -1, -1}}) {
    const Hit hit = oracle.trace(ray);
    EXPECT_EQ(hit.status, HitStatus::miss) << describe(ray);
    EXPECT_EQ(hit.t, 0);
    EXPECT_TRUE(std::isfinite(hit.u) && std::isfinite(hit.v) && std::isfinite(hit.h));
  }
}

TEST(Oracle, StaysFiniteAtTheEndsOfTheNumberRange) {
  OracleOptions options;
  options.max_cells = 1000;
  constexpr std::array magnitudes = {0.0, 1.0, -1.0, 1e-320, 1e-300, -1e-160, 1e160, -1e300, 1.7e308, -1.7e308};
  test::Random random(10);
  const auto pick = [&] { return magnitudes[static_cast<std::size_t>(random.below(10))]; };
  for (const AddressMode mode : test::all_address_modes) {
    const Oracle oracle(test::with_address(test::white_noise_map(7, 13), mode), options);
    for (int i = 0; i < 20000; ++i) {
      const Ray ray{pick(), pick(), pick(), pick(), pick(), pick(), random.below(2) ? infinity : std::abs(pick())};
      const Hit hit = oracle.trace(ray);
      ASSERT_TRUE(std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v) && std::isfinite(hit.h))
          << describe(ray);
      ASSERT_GE(hit.t, 0);
      ASSERT_LE(hit.t, ray.t_max);
    }
  }
}

TEST(Oracle, DoesNotDependOnTheDirectionsLength) {
  const HeightMap map = test::white_noise_map(7, 13);
  const Oracle oracle(map);
  test::Random random(13);
  for (int i = 0; i < 500; ++i) {
    const Ray ray = slanted(random.uniform(), random.uniform(), random.uniform(0, 7), 20, 0.1);
    for (const double scale : {0x1p-300, 0x1p-30, 0x1p40, 0x1p500}) {
      Ray scaled = ray;
      scaled.du *= scale, scaled.dv *= scale, scaled.dh *= scale;
      ASSERT_EQ(oracle.trace(scaled).t * scale, oracle.trace(ray).t) << describe(ray);
    }
  }
}

TEST(Oracle, GivesTheSameWithAnyNumberOfThreads) {
  const HeightMap map = test::white_noise_map(33, 20);
  test::Random random(14);
  std::vector<Ray> rays(10000);
  for (Ray& ray : rays) ray = hard_ray(random, map);
  const Oracle one(map, {.threads = 1});
  const std::vector<Hit> expected = one.trace(rays);
  ASSERT_EQ(expected.size(), rays.size());
  for (const unsigned threads : {0u, 2u, 3u, 16u}) {
    const std::vector<Hit> hits = Oracle(map, {.threads = threads}).trace(rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
      ASSERT_TRUE(hits[i].status == expected[i].status && hits[i].t == expected[i].t &&
                  hits[i].steps == expected[i].steps)
          << threads << " threads, " << describe(rays[i]);
  }
  for (std::size_t i = 0; i < rays.size(); i += 97) EXPECT_EQ(one.trace(rays[i]).t, expected[i].t);
  EXPECT_TRUE(one.trace(std::span<const Ray>()).empty());
}

TEST(Oracle, KeepsItsMapWhenMoved) {
  Oracle first(test::constant_map(4, 4, 0.25));
  Oracle second(std::move(first));
  Oracle third(test::constant_map(4, 4, 0.75));
  third = std::move(second);
  EXPECT_EQ(third.trace(Ray{0.3, 0.3, 1, 0, 0, -1}).t, 0.75);
}

TEST(Oracle, BringsBrokenMapsIntoRange) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Oracle broken(HeightMap{2, 2, {nan, 7, -3}, AddressMode::repeat});
  EXPECT_EQ(broken.trace(Ray{0.25, 0.25, 1, 0, 0, -1}).t, 1);
  EXPECT_EQ(broken.trace(Ray{0.75, 0.25, 1, 0, 0, -1}).t, 0);
  EXPECT_EQ(Oracle(HeightMap{}).trace(Ray{0.25, 0.25, 1, 0, 0, -1}).t, 1);
}

TEST(HitStatusNames, AreTheDesignsWords) {
  EXPECT_EQ(to_string(HitStatus::miss), "miss");
  EXPECT_EQ(to_string(HitStatus::hit), "hit");
  EXPECT_EQ(to_string(HitStatus::exhausted), "exhausted");
  EXPECT_EQ(to_string(HitStatus::inside), "inside");
  EXPECT_EQ(to_string(HitStatus::outside), "outside");
  EXPECT_EQ(to_string(static_cast<HitStatus>(17)), "unknown");
}

}  // namespace
}  // namespace relievo
