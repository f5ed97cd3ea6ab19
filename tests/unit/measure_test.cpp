#include "relievo/measure.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace relievo {
namespace {

constexpr int width = 100, height = 50;

Hit hit(double u, double v, double h) {
  Hit hit;
  hit.status = HitStatus::hit;
  hit.t = 1 - h;
  hit.u = u, hit.v = v, hit.h = h;
  return hit;
}

Hit with_status(HitStatus status) {
  Hit hit;
  hit.status = status;
  return hit;
}

ErrorFigures compare_one(const Hit& reference, const Hit& measured) {
  return compare_hits(std::vector{reference}, std::vector{measured}, width, height);
}

TEST(CompareHits, FindsNothingWrongWithEqualHits) {
  const std::vector<Hit> hits = {hit(0.1, 0.2, 0.3), with_status(HitStatus::miss), with_status(HitStatus::inside),
                                 with_status(HitStatus::outside)};
  const ErrorFigures figures = compare_hits(hits, hits, width, height);
  EXPECT_EQ(figures.rays, 4u);
  EXPECT_EQ(figures.judged, 4u);
  EXPECT_EQ(figures.wrong_percent(), 0);
  EXPECT_EQ(figures.non_finite, 0u);
  EXPECT_EQ(figures.uv_texels.max, 0);
  EXPECT_EQ(figures.height.max, 0);
}

TEST(CompareHits, CountsMissAndOutsideAsMissed) {
  EXPECT_EQ(compare_one(hit(0.1, 0.2, 0.3), with_status(HitStatus::miss)).missed, 1u);
  EXPECT_EQ(compare_one(hit(0.1, 0.2, 0.3), with_status(HitStatus::outside)).missed, 1u);
  EXPECT_EQ(compare_one(with_status(HitStatus::inside), with_status(HitStatus::miss)).missed, 1u);
}

TEST(CompareHits, CountsFalseHits) {
  EXPECT_EQ(compare_one(with_status(HitStatus::miss), hit(0.1, 0.2, 0.3)).false_hit, 1u);
  EXPECT_EQ(compare_one(with_status(HitStatus::outside), with_status(HitStatus::inside)).false_hit, 1u);
}

TEST(CompareHits, TakesInsideForAHit) {
  Hit at_start = hit(0.1, 0.2, 0.3), inside = at_start;
  inside.status = HitStatus::inside;
  EXPECT_EQ(compare_one(at_start, inside).wrong_percent(), 0);
  EXPECT_EQ(compare_one(inside, at_start).wrong_percent(), 0);
}

TEST(CompareHits, CallsHitsFurtherThanATexelApartWrongLayer) {
  const Hit reference = hit(0.5, 0.5, 0.5);
  EXPECT_EQ(compare_one(reference, hit(0.5 + 0.99 / width, 0.5, 0.5)).wrong_layer, 0u);
  EXPECT_EQ(compare_one(reference, hit(0.5 + 1.01 / width, 0.5, 0.5)).wrong_layer, 1u);
  EXPECT_EQ(compare_one(reference, hit(0.5, 0.5 - 0.99 / height, 0.5)).wrong_layer, 0u);
  EXPECT_EQ(compare_one(reference, hit(0.5, 0.5 - 1.01 / height, 0.5)).wrong_layer, 1u);
  EXPECT_EQ(compare_one(reference, hit(0.5, 0.5, 0.5 + 0.0199)).wrong_layer, 0u);
  EXPECT_EQ(compare_one(reference, hit(0.5, 0.5, 0.5 + 0.0201)).wrong_layer, 1u);
  EXPECT_EQ(compare_one(reference, hit(1.5, 0.5, 0.5)).wrong_layer, 1u) << "uv is not wrapped";
}

TEST(CompareHits, CountsExhaustedApart) {
  const ErrorFigures figures = compare_one(hit(0.1, 0.2, 0.3), with_status(HitStatus::exhausted));
  EXPECT_EQ(figures.exhausted, 1u);
  EXPECT_EQ(figures.missed, 0u);
  EXPECT_EQ(figures.judged, 1u);
}

TEST(CompareHits, SetsAmbiguousAndUndecidedReferencesApart) {
  Hit ambiguous = hit(0.1, 0.2, 0.3);
  ambiguous.ambiguous = true;
  const std::vector<Hit> reference = {ambiguous, with_status(HitStatus::exhausted), hit(0.1, 0.2, 0.3)};
  const std::vector<Hit> measured(3, with_status(HitStatus::miss));
  const ErrorFigures figures = compare_hits(reference, measured, width, height);
  EXPECT_EQ(figures.rays, 3u);
  EXPECT_EQ(figures.ambiguous, 1u);
  EXPECT_EQ(figures.judged, 1u);
  EXPECT_EQ(figures.missed, 1u);
  EXPECT_EQ(figures.percent(figures.missed), 100);
}

TEST(CompareHits, NeverTakesNonFiniteForRight) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ErrorFigures at_nan = compare_one(hit(0.1, 0.2, 0.3), hit(nan, 0.2, 0.3));
  EXPECT_EQ(at_nan.non_finite, 1u);
  EXPECT_EQ(at_nan.wrong_layer, 1u);
  Hit late = hit(0.1, 0.2, 0.3);
  late.t = std::numeric_limits<double>::infinity();
  EXPECT_EQ(compare_one(hit(0.1, 0.2, 0.3), late).non_finite, 1u);
  Hit miss = with_status(HitStatus::miss);
  miss.h = nan;
  EXPECT_EQ(compare_one(with_status(HitStatus::miss), miss).non_finite, 1u);
}

TEST(CompareHits, CountsWhatTheStageMadeAMissWhetherItIsJudgedOrNot) {
  Hit ambiguous = hit(0.1, 0.2, 0.3), sanitized = with_status(HitStatus::miss);
  ambiguous.ambiguous = true;
  sanitized.sanitized = true;
  EXPECT_EQ(compare_one(ambiguous, sanitized).non_finite, 1u);
  EXPECT_EQ(compare_one(with_status(HitStatus::miss), sanitized).non_finite, 1u);
}

TEST(CompareHits, HasNoFiguresOfNothing) {
  Hit ambiguous = hit(0.1, 0.2, 0.3);
  ambiguous.ambiguous = true;
  const ErrorFigures unjudged = compare_one(ambiguous, ambiguous);
  EXPECT_TRUE(std::isnan(unjudged.wrong_percent())) << "no ray is judged";
  const ErrorFigures missed = compare_one(hit(0.1, 0.2, 0.3), with_status(HitStatus::miss));
  EXPECT_EQ(missed.wrong_percent(), 100);
  EXPECT_TRUE(std::isnan(missed.uv_texels.p99) && std::isnan(missed.height.max)) << "no hit is right";
}

TEST(CompareHits, GivesNearestRankQuantiles) {
  std::vector<Hit> reference, measured;
  for (int i = 1; i <= 200; ++i) {  // in a scrambled order
    const double deviation = ((i * 77) % 200 + 1) * 1e-3;
    reference.push_back(hit(0.5, 0.5, 0.5));
    measured.push_back(hit(0.5 + deviation / width, 0.5, 0.5 - deviation / 20));
  }
  const ErrorFigures figures = compare_hits(reference, measured, width, height);
  EXPECT_NEAR(figures.uv_texels.p50, 0.100, 1e-12);
  EXPECT_NEAR(figures.uv_texels.p99, 0.198, 1e-12);
  EXPECT_NEAR(figures.uv_texels.max, 0.200, 1e-12);
  EXPECT_NEAR(figures.height.p50, 0.100 / 20, 1e-12);
  EXPECT_NEAR(figures.height.max, 0.200 / 20, 1e-12);
}

TEST(CompareHits, KeepsWrongHitsOutOfTheQuantiles) {
  const std::vector<Hit> reference(3, hit(0.5, 0.5, 0.5));
  const std::vector<Hit> measured = {hit(0.5, 0.5, 0.51), hit(0.9, 0.5, 0.5), with_status(HitStatus::miss)};
  const ErrorFigures figures = compare_hits(reference, measured, width, height);
  EXPECT_EQ(figures.uv_texels.max, 0);
  EXPECT_NEAR(figures.height.max, 0.01, 1e-15);
}

TEST(CompareHits, AveragesTheMeasuredCost) {
  std::vector<Hit> measured(2, hit(0.5, 0.5, 0.5));
  measured[0].steps = 10, measured[0].fetches = 40;
  measured[1].steps = 30, measured[1].fetches = 60;
  const std::vector<Hit> reference(2, hit(0.5, 0.5, 0.5));
  const ErrorFigures figures = compare_hits(reference, measured, width, height);
  EXPECT_EQ(figures.mean_steps, 20);
  EXPECT_EQ(figures.mean_fetches, 50);
}

TEST(CompareHits, CountsNothingWithoutRays) {
  const ErrorFigures figures = compare_hits({}, {}, width, height);
  EXPECT_EQ(figures.rays, 0u);
  EXPECT_TRUE(std::isnan(figures.wrong_percent()));
  EXPECT_EQ(figures.mean_steps, 0);
}

}  // namespace
}  // namespace relievo
