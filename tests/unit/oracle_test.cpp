#include "relievo/oracle.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>

#include "oracle/walk.hpp"
#include "support/brute_force_hit.hpp"
#include "support/height_maps.hpp"

namespace relievo {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A ray in the given direction on the uv plane, at an angle under the horizon of a map with unit height.
Ray slanted(double u, double v, double heading, double degrees, double slope_scale = 1) {
  const double a = degrees * std::numbers::pi / 180;
  return {u, v, 1, std::cos(heading) * std::cos(a), std::sin(heading) * std::cos(a), -std::sin(a) / slope_scale};
}

/// Rays of every kind: on grid lines and through corners, axis-parallel, vertical, horizontal, from above, from below,
/// along the plateaus, short ones. All end, so that brute force does too.
Ray hard_ray(test::Random& random, const HeightMap& map) {
  const auto coordinate = [&](int extent) {
    const int k = random.below(5);
    if (k == 0) return (random.below(extent + 2) - 0.5) / extent;  // on a grid line
    if (k == 1) return random.below(17) / 8.0 - 0.5;               // dyadic, often on the domain's side
    return random.uniform(-0.5, 1.5);
  };
  constexpr std::array heights = {1.0, 1.0, 1.0, 0.0, 0.5, 0.25, 1.25};
  Ray ray{coordinate(map.width), coordinate(map.height), heights[static_cast<std::size_t>(random.below(7))]};
  if (random.below(4) == 0) ray.h = random.uniform(-0.1, 1.2);
  if (random.below(3) == 0) ray.h += random.uniform(-3e-5, 3e-5);  // passes close to what it would have touched
  const double slope = std::exp2(random.uniform(-8, 3));
  switch (random.below(6)) {
    case 0:  // diagonal: from corner to corner where it starts on one
      ray.du = (random.below(2) ? 1.0 : -1.0) / map.width, ray.dv = (random.below(2) ? 1.0 : -1.0) / map.height;
      break;
    case 1:
      ray.du = random.below(2) ? 1 : -1;
      break;
    case 2:
      ray.dv = random.below(2) ? 1 : -1;
      break;
    case 3:
      if (random.below(4) == 0) break;  // vertical
      [[fallthrough]];
    default:
      ray.du = random.uniform(-1, 1), ray.dv = random.uniform(-1, 1);
  }
  constexpr std::array signs = {-1.0, -1.0, -1.0, 0.0, 1.0};
  ray.dh = slope * signs[static_cast<std::size_t>(random.below(5))];
  if (ray.dh == 0 && ray.du == 0 && ray.dv == 0) ray.dh = -1;
  if (ray.dh == 0 || random.below(4) == 0) ray.t_max = random.uniform(0, 4);
  if (ray.dh != 0 && std::max(std::abs(ray.du), std::abs(ray.dv)) / std::abs(ray.dh) > 100) ray.t_max = 8;
  return ray;
}

/// Empty when the oracle's hit is what brute force finds. Exact touches can be decided either way by rounding, so rays
/// that brute force calls ambiguous within 10⁻¹³ need only be ambiguous for the oracle too.
std::string difference(const test::BruteForce& truth, const Ray& ray, const Hit& hit) {
  const auto expected = truth.trace(ray);
  bool flag_is_certain = true;
  if (expected.ambiguous || hit.ambiguous) {
    if (truth.trace(ray, 1e-13L).ambiguous) return hit.ambiguous ? "" : "a touch is not ambiguous";
    flag_is_certain = truth.trace(ray, 0.999999e-5L).ambiguous == truth.trace(ray, 1.000001e-5L).ambiguous;
  }
  if (!std::isfinite(hit.t) || !std::isfinite(hit.u) || !std::isfinite(hit.v) || !std::isfinite(hit.h))
    return "is not finite";
  if (hit.status != expected.status)
    return "status is " + std::string(to_string(hit.status)) + ", expected " + std::string(to_string(expected.status));
  if (flag_is_certain && hit.ambiguous != expected.ambiguous)
    return "ambiguous is " + std::to_string(hit.ambiguous) + ", expected " + std::to_string(expected.ambiguous);
  const bool is_hit = hit.status == HitStatus::hit || hit.status == HitStatus::inside;
  // A shallow crossing turns the height's rounding into more of t: the height decides there, on the same piece.
  if (is_hit && std::abs(hit.t - double(expected.t)) > 1e-7)
    return "t is " + std::to_string(hit.t) + ", expected " + std::to_string(double(expected.t));
  if (hit.status == HitStatus::hit && hit.t > 0 && std::abs(hit.t - double(expected.t)) > 1e-12 &&
      std::abs(double(truth.clearance(ray, hit.t))) > 1e-13)
    return "clearance is " + std::to_string(double(truth.clearance(ray, hit.t)));
  return "";
}

std::string describe(const Ray& r) {
  char text[400];
  std::snprintf(text, sizeof text, "ray %.17g %.17g %.17g + t (%.17g %.17g %.17g) to %g", r.u, r.v, r.h, r.du, r.dv,
                r.dh, r.t_max);
  return text;
}

/// Traces random hard rays over every small map with every address mode; returns what differs from brute force.
using Tracer = std::function<Hit(const Oracle&, const Ray&)>;
std::vector<std::string> differences_on_hard_rays(int rays_per_map, std::uint64_t seed, const Tracer& tracer) {
  std::vector<std::string> found;
  for (const AddressMode mode : test::all_address_modes) {
    for (const test::NamedMap& named : test::small_maps()) {
      const HeightMap map = test::with_address(named.map, mode);
      const Oracle oracle(map);
      const test::BruteForce truth(map);
      test::Random random(seed);
      for (int i = 0; i < rays_per_map; ++i) {
        const Ray ray = hard_ray(random, map);
        const std::string what = difference(truth, ray, tracer(oracle, ray));
        if (!what.empty())
          found.push_back(named.name + ", " + std::string(to_string(mode)) + ": " + what + "; " + describe(ray));
      }
    }
  }
  return found;
}

std::string first_lines(const std::vector<std::string>& lines) {
  std::string text = std::to_string(lines.size()) + " differences\n";
  for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 10); ++i) text += lines[i] + "\n";
  return text;
}

TEST(Oracle, AgreesWithBruteForceOnHardRays) {
  const auto found = differences_on_hard_rays(500, 11, [](const Oracle& o, const Ray& r) { return o.trace(r); });
  EXPECT_TRUE(found.empty()) << first_lines(found);
}

TEST(Oracle, ComparisonWithBruteForceCatchesSeededFaults) {
  const auto late = [](const Oracle& o, const Ray& r) {
    Hit hit = o.trace(r);
    hit.t += 1e-5;
    return hit;
  };
  EXPECT_GT(differences_on_hard_rays(20, 12, late).size(), 100u);
  const auto swapped = [](const Oracle& o, Ray r) {
    std::swap(r.u, r.v), std::swap(r.du, r.dv);
    return o.trace(r);
  };
  EXPECT_GT(differences_on_hard_rays(20, 12, swapped).size(), 100u);
  const auto unflagged = [](const Oracle& o, const Ray& r) {
    Hit hit = o.trace(r);
    hit.ambiguous = false;
    return hit;
  };
  EXPECT_GT(differences_on_hard_rays(100, 12, unflagged).size(), 10u);
}

TEST(Oracle, GivesTheSameWithAndWithoutThePyramid) {
  std::size_t counts[5] = {}, ambiguous = 0;
  for (const AddressMode mode : test::all_address_modes) {
    for (const test::NamedMap& named : test::small_maps()) {
      const HeightMap map = test::with_address(named.map, mode);
      const oracle::Lattice lattice(map);
      const oracle::MaxPyramid pyramid(lattice);
      OracleOptions options;
      options.max_cells = 3000;
      test::Random random(5);
      for (int i = 0; i < 1500; ++i) {
        Ray ray = hard_ray(random, map);
        if (i % 4 == 0) ray.t_max = infinity;
        const Hit fast = oracle::find_first_hit(lattice, &pyramid, options, ray);
        const Hit plain = oracle::find_first_hit(lattice, nullptr, options, ray);
        ++counts[static_cast<int>(plain.status)];
        ambiguous += plain.ambiguous;
        ASSERT_TRUE(fast.status == plain.status && fast.t == plain.t && fast.u == plain.u && fast.v == plain.v &&
                    fast.h == plain.h && fast.ambiguous == plain.ambiguous)
            << named.name << ", " << to_string(mode) << ": " << describe(ray);
      }
    }
  }
  for (const std::size_t count : counts) EXPECT_GT(count, 100u) << "the rays are not of every kind";
  EXPECT_GT(ambiguous, 100u);
}

TEST(Oracle, GivesTheSameWithAndWithoutThePyramidOnALargeMap) {
  const HeightMap map = test::smooth_noise_map(500, 300);
  const oracle::Lattice lattice(map);
  const oracle::MaxPyramid pyramid(lattice);
  test::Random random(6);
  std::uint64_t fast_cells = 0, plain_cells = 0;
  for (int i = 0; i < 5000; ++i) {
    const Ray ray = slanted(random.uniform(), random.uniform(), random.uniform(0, 7), 1 + random.below(60), 0.1);
    const Hit fast = oracle::find_first_hit(lattice, &pyramid, {}, ray);
    const Hit plain = oracle::find_first_hit(lattice, nullptr, {}, ray);
    fast_cells += fast.steps, plain_cells += plain.steps;
    ASSERT_TRUE(fast.status == plain.status && fast.t == plain.t && fast.ambiguous == plain.ambiguous) << describe(ray);
  }
  EXPECT_LT(fast_cells * 20, plain_cells) << "the pyramid passes over nothing";
}

TEST(Oracle, HitsGrazingRaysOnALargeMap) {
  const HeightMap map = test::smooth_noise_map(96, 160);
  const Oracle oracle(map);
  const test::BruteForce truth(map);
  test::Random random(8);
  std::vector<std::string> found;
  for (const double degrees : {0.1, 1.0, 20.0})
    for (int i = 0; i < 25; ++i) {
      const Ray ray = slanted(random.uniform(), random.uniform(), random.uniform(0, 7), degrees, i % 2 ? 0.1 : 0.5);
      const std::string what = difference(truth, ray, oracle.trace(ray));
      if (!what.empty()) found.push_back(what + "; " + describe(ray));
    }
  EXPECT_TRUE(found.empty()) << first_lines(found);
}

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
