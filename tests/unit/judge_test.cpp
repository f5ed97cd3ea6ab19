/// Every claim of `relievo conform` fails on a row that breaks it.
#include <gtest/gtest.h>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {
namespace {

/// Rows that keep every claim: two backends, one sphere, one technique that claims first hits.
struct Case {
  Case() {
    static const Registry loaded = *load_registry();
    input.registry = &loaded;
    input.techniques = {"relief", "exact"};
    LoadedScene sphere;
    sphere.scene.mesh.kind = MeshKind::sphere;
    input.scenes.emplace_back("ball", sphere);
    BackendInfo vulkan, opengl;
    vulkan.name = "vulkan";
    opengl.name = "opengl";
    evaluation.backends = {{opengl, {}}, {vulkan, {}}};
    evaluation.rays.push_back({"map", "exact", "vulkan", "exact", 20, {}});
    evaluation.rays[0].error.judged = 1000;
    evaluation.ray_agreements.push_back({"map", "relief", "exact", 20, 1000000, 100});
    evaluation.ray_agreements.push_back({"map", "relief", "hardware", 20, 1000000, 98});
    evaluation.pictures.push_back({"ball", "prism", "relief", "vulkan", "", "", "", 0, true, 0});
    evaluation.picture_agreements.push_back({"ball", "prism", "relief", "opengl", "vulkan", {}, -1, {}});
    evaluation.picture_agreements.push_back({"ball", "prism", "relief", "vulkan", "vertex", {}, -1, {}});
    PixelOffsets offsets;
    offsets.judged = 100;
    offsets.pixels.p99 = 0.01;
    evaluation.picture_agreements.push_back({"ball", "prism", "exact", "vulkan", "oracle", {}, 0, offsets});
    evaluation.cracks.push_back({"ball", "relief", "vulkan", 1, 0});
  }

  /// Names of the checks that fail.
  std::vector<std::string> failures() {
    judge(input, evaluation);
    std::vector<std::string> names;
    for (const Check& check : evaluation.checks) {
      if (!check.passed) names.push_back(check.name);
    }
    return names;
  }

  EvaluationInput input;
  Evaluation evaluation;
};

using Names = std::vector<std::string>;

TEST(Judge, PassesRowsThatKeepEveryClaim) {
  Case good;
  EXPECT_EQ(good.failures(), Names());
  EXPECT_GE(good.evaluation.checks.size(), 8U) << "a claim is not judged at all";
}

TEST(Judge, FailsRaysThatDifferBetweenBackends) {
  Case bad;
  bad.evaluation.ray_agreements[0].equal_percent = 99.98;
  EXPECT_EQ(bad.failures(), Names({"rays equal between backends, t within 4 ulp, filter exact"}));
}

TEST(Judge, FailsOneRayThatIsWrongWhereFirstHitsAreCertain) {
  for (std::uint64_t ErrorFigures::*figure :
       {&ErrorFigures::missed, &ErrorFigures::false_hit, &ErrorFigures::wrong_layer, &ErrorFigures::exhausted}) {
    Case bad;
    bad.evaluation.rays[0].error.*figure = 1;
    EXPECT_EQ(bad.failures(),
              Names({"rays missed, falsely hit, on a wrong layer or exhausted where first hits are certain"}));
    bad.evaluation.checks.clear();
    bad.evaluation.rays[0].technique = "relief";
    EXPECT_EQ(bad.failures(), Names()) << "relief mapping claims no such thing";
  }
}

TEST(Judge, LetsRaysRunOutOfStepsWhereTheBudgetIsSetOrTheWayTooLong) {
  Case budget;
  budget.evaluation.rays[0].error.exhausted = 1;
  budget.input.values["exact.max_steps"] = 16;
  EXPECT_EQ(budget.failures(), Names());
  Case far;
  far.evaluation.rays[0].error.exhausted = 1;
  far.input.ray_cases.push_back({"map", {}, 400});
  EXPECT_EQ(far.failures(), Names()) << "1099 texture widths at 20°";
}

TEST(Judge, FailsAPictureThatShowsNothingWhereTheOracleDoes) {
  Case bad;
  PictureAgreement& agreement = bad.evaluation.picture_agreements[2];
  agreement.offsets = PixelOffsets();  // no pixel in common
  agreement.difference.mask_iou = 0;
  const Names offsets = {"pixel offset against the oracle's picture where first hits are certain, p99"};
  EXPECT_EQ(bad.failures(), offsets);
  bad.evaluation.checks.clear();
  bad.evaluation.picture_agreements.push_back(bad.evaluation.picture_agreements[0]);
  bad.evaluation.picture_agreements.back() = {"ball",   "prism", "exact", "opengl",
                                              "oracle", {},      0,       PixelOffsets{9, 0, {0, 0, 0}}};
  EXPECT_EQ(bad.failures(), offsets) << "a good row behind it hides nothing";
  bad.evaluation.checks.clear();
  agreement = bad.evaluation.picture_agreements[2];
  bad.evaluation.picture_agreements[2].difference.mask_iou = 1;
  EXPECT_EQ(bad.failures(), Names()) << "nothing is to be seen";
}

TEST(Judge, FailsFeaturesThatMovedWhereFirstHitsAreCertain) {
  Case bad;
  bad.evaluation.picture_agreements[2].offsets->pixels.p99 = 0.11;
  EXPECT_EQ(bad.failures(), Names({"pixel offset against the oracle's picture where first hits are certain, p99"}));
  bad.evaluation.checks.clear();
  bad.evaluation.picture_agreements[2].technique = "relief";
  EXPECT_EQ(bad.failures(), Names()) << "relief mapping claims no such thing";
}

TEST(Judge, FailsPicturesThatDifferBetweenBackends) {
  Case bad;
  bad.evaluation.picture_agreements[0].difference.within_percent = 99.8;
  EXPECT_EQ(bad.failures(), Names({"pixels within 1/255 between backends"}));
}

TEST(Judge, FailsASilhouetteThatIsNotTheDisplacedMeshs) {
  Case bad;
  bad.evaluation.picture_agreements[1].difference.mask_iou = 0.98;
  EXPECT_EQ(bad.failures(), Names({"prism silhouette against the displaced mesh, IoU"}));
}

TEST(Judge, FailsOneCrackPixel) {
  Case bad;
  bad.evaluation.cracks[0].cracks = 1;
  EXPECT_EQ(bad.failures(), Names({"crack pixels under random vertex orders"}));
}

TEST(Judge, FailsAPictureThatChanges) {
  Case bad;
  bad.evaluation.pictures[0].repeatable = false;
  EXPECT_EQ(bad.failures(), Names({"pictures that change from run to run"}));
}

TEST(Judge, SaysNothingOfChangesWhereNothingIsDrawnTwice) {
  Case once;
  once.input.repeats = 1;
  EXPECT_EQ(once.failures(), Names());
  for (const Check& check : once.evaluation.checks) EXPECT_NE(check.name, "pictures that change from run to run");
}

TEST(Judge, FailsOneRayWithANumberThatIsNone) {
  Case bad;
  bad.evaluation.rays[0].error.non_finite = 1;
  EXPECT_EQ(bad.failures(), Names({"rays with NaN or Inf"}));
}

TEST(Judge, FailsOneValidationMessage) {
  Case bad;
  bad.evaluation.messages = {"VUID"};
  EXPECT_EQ(bad.failures(), Names({"validation and debug messages"}));
}

}  // namespace
}  // namespace relievo::cli
