/// The oracle against brute force in long double, and its two walks against each other.
#include <gtest/gtest.h>

#include <functional>

#include "oracle/walk.hpp"
#include "relievo/oracle.hpp"
#include "support/brute_force_hit.hpp"
#include "support/hard_rays.hpp"
#include "support/height_maps.hpp"

namespace relievo {
namespace {

using test::describe;
using test::hard_ray;
using test::slanted;

constexpr double infinity = std::numeric_limits<double>::infinity();

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

}  // namespace
}  // namespace relievo
