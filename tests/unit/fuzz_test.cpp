/// Fuzzing: rounds can be drawn again, keep within the descriptors' ranges, and every kind of fault is counted.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "evaluation/fuzz.hpp"
#include "support/pipeline.hpp"

namespace relievo::cli {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using test::registry;

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

TEST(Fuzz, ARoundCanBeDrawnAgain) {
  for (std::uint64_t round = 0; round < 20; ++round) {
    const FuzzRound a = draw_round(7, round, 300), b = draw_round(7, round, 300), c = draw_round(8, round, 300);
    EXPECT_EQ(a.map.texels, b.map.texels);
    ASSERT_EQ(a.rays.size(), b.rays.size());
    std::size_t other = a.rays.size() != c.rays.size();
    for (std::size_t i = 0; i < a.rays.size(); ++i) {
      for (const double Ray::*field : {&Ray::u, &Ray::v, &Ray::h, &Ray::du, &Ray::dv, &Ray::dh, &Ray::t_max}) {
        ASSERT_TRUE(same(a.rays[i].*field, b.rays[i].*field));
        if (i < c.rays.size()) other += !same(a.rays[i].*field, c.rays[i].*field);
      }
    }
    EXPECT_GT(other, 0U) << "the seed changes nothing";
    EXPECT_EQ(draw_values(registry(), "relief", 7, round), draw_values(registry(), "relief", 7, round));
  }
}

TEST(Fuzz, RoundsHoldWhatIsAdversarial) {
  std::set<AddressMode> addresses;
  std::set<std::pair<int, int>> sizes;
  bool hardware = false, nan = false, infinite = false, zero_direction = false, denormal = false, zero = false,
       one = false;
  for (std::uint64_t round = 0; round < 200; ++round) {
    const FuzzRound r = draw_round(1, round, 256);
    EXPECT_GT(r.judged, 100U);
    EXPECT_GT(r.rays.size(), r.judged);
    addresses.insert(r.map.address);
    sizes.insert({r.map.width, r.map.height});
    hardware = hardware || r.filter == HeightFilter::hardware;
    for (const float t : r.map.texels) {
      ASSERT_TRUE(t >= 0 && t <= 1);
      denormal = denormal || std::fpclassify(t) == FP_SUBNORMAL;
      zero = zero || t == 0;
      one = one || t == 1;
    }
    for (const Ray& ray : r.rays) {
      nan = nan || std::isnan(ray.u) || std::isnan(ray.dh);
      infinite = infinite || std::isinf(ray.h) || std::isinf(ray.dv);
      zero_direction = zero_direction || (ray.du == 0 && ray.dv == 0);
    }
  }
  EXPECT_EQ(addresses.size(), 4U);
  EXPECT_GT(sizes.size(), 50U);
  EXPECT_TRUE(hardware && nan && infinite && zero_direction && denormal && zero && one);
}

TEST(Fuzz, ValuesAreWithinTheDescriptorsRanges) {
  for (const auto& [name, technique] : registry().techniques) {
    std::map<std::string, std::set<double>> seen;
    for (std::uint64_t round = 0; round < 100; ++round) {
      const auto values = draw_values(registry(), name, 1, round);
      for (const Parameter& p : technique.parameters) {
        const double value = values.at(name + "." + p.name);
        ASSERT_TRUE(value >= p.minimum && value <= p.maximum) << name << "." << p.name << " = " << value;
        ASSERT_TRUE(!p.is_integer || value == std::floor(value)) << name << "." << p.name;
        seen[p.name].insert(value);
      }
      for (const std::string& map : technique.maps) {
        for (const Parameter& p : registry().maps.at(map).parameters)
          EXPECT_EQ(values.contains(map + "." + p.name), p.choices.empty() || p.software_value) << map << "." << p.name;
      }
    }
    for (const Parameter& p : technique.parameters) {
      EXPECT_TRUE(p.maximum == p.minimum || seen[p.name].size() > 1) << name << "." << p.name << " never changes";
      EXPECT_TRUE(seen[p.name].contains(p.minimum) && seen[p.name].contains(p.value)) << name << "." << p.name;
    }
  }
}

/// A round whose hits are the oracle's own.
struct Judged {
  Judged() {
    round.map = make_hard_map(HardMap{.kind = "constant", .width = 4, .height = 4}, AddressMode::repeat);
    for (int i = 0; i < 8; ++i) round.rays.push_back({0.125 * i, 0.25, 1, 0.25, 0.125, -0.5});
    round.judged = 6;
    hits = Oracle(round.map).trace(round.rays);
    truth.assign(hits.begin(), hits.begin() + 6);
  }
  std::vector<std::string> judge() {
    std::vector<std::string> findings;
    judge_fuzz(round, hits, truth, row, findings);
    return findings;
  }
  FuzzRound round;
  std::vector<Hit> hits, truth;
  FuzzRow row;
};

TEST(Fuzz, RightHitsAreNoFinding) {
  Judged good;
  EXPECT_TRUE(good.judge().empty());
  EXPECT_EQ(good.row.hits, 8U);
  EXPECT_EQ(good.row.judged, 6U);
  EXPECT_EQ(good.row.unsound + good.row.non_finite + good.row.bad_status, 0U);
}

TEST(Fuzz, EveryKindOfFaultIsCounted) {
  Judged nan;
  nan.hits[7].h = not_a_number;
  nan.hits[6].t = std::numeric_limits<double>::infinity();
  const auto findings = nan.judge();
  ASSERT_EQ(findings.size(), 1U) << "one of each kind";
  EXPECT_NE(findings[0].find("NaN or Inf: ray 0.75,0.25"), std::string::npos) << findings[0];
  EXPECT_EQ(nan.row.non_finite, 2U);

  Judged status;
  status.hits[7].status = static_cast<HitStatus>(9);
  EXPECT_EQ(status.judge().size(), 1U);
  EXPECT_EQ(status.row.bad_status, 1U);

  for (const HitStatus wrong : {HitStatus::miss, HitStatus::outside}) {
    Judged missed;
    missed.hits[2].status = wrong;
    EXPECT_EQ(missed.judge().size(), 1U);
    EXPECT_EQ(missed.row.unsound, 1U);
  }
  Judged exhausted;
  exhausted.hits[2].status = HitStatus::exhausted;
  EXPECT_TRUE(exhausted.judge().empty()) << "said so: no fault";
  EXPECT_EQ(exhausted.row.exhausted, 1U);
  Judged unclaimed;
  unclaimed.hits[2].status = HitStatus::miss;
  unclaimed.truth.clear();
  EXPECT_TRUE(unclaimed.judge().empty());
}

}  // namespace
}  // namespace relievo::cli
