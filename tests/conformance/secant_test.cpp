/// The secant method: faster than false position, and kept in its interval by a fallback that can be switched off.
#include "support/linear_claims.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

struct Refinement {
  ErrorFigures figures;
  std::vector<Hit> hits;
};

class Secant : public ::testing::Test {
 protected:
  Refinement refine(const std::string& technique, const std::map<std::string, double>& values) const {
    std::map<std::string, double> own;
    for (const auto& [name, value] : values) own[technique + "." + name] = value;
    auto hits = trace_on("vulkan", map_, rays_, request_of(technique, own));
    return {compare_hits(truth_, hits, map_.width, map_.height), std::move(hits)};
  }

  const HeightMap map_ = smooth_noise_map(64, 64);
  const std::vector<Ray> rays_ = make_view_rays(30, 0.2, 48, 48);
  const std::vector<Hit> truth_ = Oracle(map_).trace(rays_);
};

TEST_F(Secant, ConvergesFasterThanFalsePosition) {
  const auto secant = refine("secant", {{"steps", 5}});
  const auto chords = refine("linear_false_position", {{"chord_steps", 5}});
  EXPECT_LT(secant.figures.height.p99, chords.figures.height.p99);
  EXPECT_LE(secant.figures.mean_fetches, chords.figures.mean_fetches);
  EXPECT_LE(secant.figures.wrong_percent(), chords.figures.wrong_percent());
}

TEST_F(Secant, ManyStepsEndOnTheSurface) {
  const auto secant = refine("secant", {{"steps", 40}});
  EXPECT_EQ(secant.figures.exhausted, 0U);
  // An ulp of t is about 1e-7, and float interpolation adds a few more.
  EXPECT_LT(secant.figures.height.max, 2e-6);
}

TEST_F(Secant, WithoutItsFallbackARayThatNeedsItIsExhausted) {
  const std::map<std::string, double> whole = {{"linear_steps", 1}, {"steps", 8}, {"fallback", 0}};
  const auto bare = refine("secant", whole);
  EXPECT_GT(bare.figures.percent(bare.figures.exhausted), 1) << "the pure method always works here: no test";
  std::map<std::string, double> safeguarded = whole;
  safeguarded["fallback"] = 1;
  const auto kept = refine("secant", safeguarded);
  EXPECT_EQ(kept.figures.exhausted, 0U);
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (bare.hits[i].status == HitStatus::exhausted) continue;
    ASSERT_EQ(bare.hits[i].t, kept.hits[i].t) << "the fallback meddles with " << describe(rays_[i]);
  }
}

}  // namespace
}  // namespace relievo::test
