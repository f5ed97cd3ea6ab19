/// The pictures of an evaluation do not depend on how many are drawn at once, and a backend that draws something else
/// the second time, or fails, is noticed.
#include "evaluation/scene_run.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>

#include "support/height_maps.hpp"
#include "support/pipeline.hpp"
#include "support/scenes.hpp"

namespace relievo::cli {
namespace {

constexpr int pixels = 32 * 32;

/// Passes Jobs on to a real backend, which several threads may not use: each has its own.
class Watched : public Backend {
 public:
  explicit Watched(const std::string& name) {
    BackendOptions options;
    options.validation = true;
    Result<std::unique_ptr<Backend>> opened = open_backend(name, options);
    if (!opened) throw std::runtime_error(format(opened.error()));
    real_ = *std::move(opened);
  }
  const BackendInfo& info() const override { return real_->info(); }
  Result<JobResult> execute(const Job& job) override {
    if (++jobs == failing_job) return fail(ErrorCode::backend, "test.lost", "the device is lost");
    if (job.name.starts_with("bake ")) baking_threads.insert(std::this_thread::get_id());
    most_pictures = std::max(most_pictures, job.read_backs.size());
    Result<JobResult> result = real_->execute(job);
    if (result && job.read_backs.size() == altered_size) result->read_backs[altered].front() ^= std::byte{1};
    return result;
  }

  int jobs = 0, failing_job = -1;
  std::set<std::thread::id> baking_threads;
  std::size_t most_pictures = 0;
  std::size_t altered_size = 0, altered = 0;  ///< the Job that returns so much, and what of it is another picture

 private:
  std::unique_ptr<Backend> real_;
};

struct Drawing {
  Drawing() {
    input.registry = &test::registry();
    input.techniques = {"relief", "parallax", "exact"};
    input.repeats = 1;
    input.time = false;
    LoadedScene parts{test::make_scene(MeshKind::torus, 32), {}, test::smooth_noise_map(20, 16)};
    parts.mesh = test::mesh_of(parts.scene);
    input.scenes.emplace_back("ring", std::move(parts));
    add("vulkan");
    add("opengl");
  }

  void add(const std::string& name) {
    auto backend = std::make_unique<Watched>(name);
    watched[name] = backend.get();
    backends[name] = std::move(backend);
  }

  Status run() {
    Progress progress("pictures", 1);
    return evaluate_pictures(input, backends, evaluation, progress);
  }

  /// All rows, as text.
  std::vector<std::string> rows() const {
    std::vector<std::string> texts;
    for (const PictureRow& p : evaluation.pictures)
      texts.push_back(fmt::format("{} {} {} {} {}", p.scene, p.stage, p.technique, p.backend, p.repeatable));
    for (const PictureAgreement& a : evaluation.picture_agreements) {
      texts.push_back(fmt::format("{} {} {} {} {} {} {} {} {}", a.scene, a.stage, a.technique, a.left, a.right,
                                  a.difference.psnr, a.difference.mask_iou, a.flip,
                                  a.offsets ? a.offsets->pixels.p99 : -1));
    }
    for (const CrackRow& c : evaluation.cracks)
      texts.push_back(fmt::format("{} {} {} {} {}", c.scene, c.technique, c.backend, c.seed, c.cracks));
    return texts;
  }

  std::vector<std::string> changing() const {
    std::vector<std::string> names;
    for (const PictureRow& p : evaluation.pictures) {
      if (!p.repeatable) names.push_back(fmt::format("{} {} {}", p.stage, p.technique, p.backend));
    }
    return names;
  }

  EvaluationInput input;
  OpenBackends backends;
  std::map<std::string, Watched*> watched;
  Evaluation evaluation;
};

TEST(EvaluatePictures, AreTheSameHoweverManyAreDrawnAtOnce) {
  Drawing all, each;
  all.input.repeats = each.input.repeats = 2;
  each.input.pixels_at_once = pixels;
  const Status drawn = all.run(), drawn_each = each.run();
  ASSERT_TRUE(drawn) << format(drawn.error());
  ASSERT_TRUE(drawn_each) << format(drawn_each.error());
  EXPECT_EQ(all.rows(), each.rows());
  EXPECT_EQ(all.evaluation.messages, std::vector<std::string>());
  // Per backend: 3 of surface, 3 of prism, 1 of vertex, and the oracle's two.
  EXPECT_EQ(all.evaluation.pictures.size(), 2U * 9);
  EXPECT_EQ(all.evaluation.cracks.size(), 2U * 3 * 2) << "of relief and exact, in three orders";
  EXPECT_EQ(all.watched["opengl"]->most_pictures, 2U * 7) << "all again, in two rounds";
  EXPECT_EQ(each.watched["opengl"]->most_pictures, 3U) << "one technique in all random orders";
}

TEST(EvaluatePictures, OfPrismsAndOffsetsWhatIsJudgedMayBeAll) {
  Drawing drawing;
  drawing.input.all_pictures = false;
  const Status drawn = drawing.run();
  ASSERT_TRUE(drawn) << format(drawn.error());
  std::map<std::string, std::set<std::string>> techniques;  // by stage
  for (const PictureRow& p : drawing.evaluation.pictures) techniques[p.stage].insert(p.technique);
  EXPECT_EQ(techniques["surface"], (std::set<std::string>{"relief", "parallax", "exact", "oracle"}));
  EXPECT_EQ(techniques["prism"], (std::set<std::string>{"relief", "exact", "oracle"}));
  std::set<std::string> with_offsets;
  for (const PictureAgreement& a : drawing.evaluation.picture_agreements) {
    if (a.offsets) with_offsets.insert(a.stage + " " + a.technique);
  }
  EXPECT_EQ(with_offsets, (std::set<std::string>{"surface exact", "prism exact"}));
}

TEST(EvaluatePictures, MoreRoundsThanFitInOneJobAreDrawnInSeveral) {
  Drawing drawing;
  drawing.input.repeats = 5;
  drawing.input.time = true;
  drawing.input.pixels_at_once = 3 * pixels;
  drawing.input.crack_seeds = 1;
  const Status drawn = drawing.run();
  ASSERT_TRUE(drawn) << format(drawn.error());
  EXPECT_EQ(drawing.watched["vulkan"]->most_pictures, 3U);
  for (const PictureRow& row : drawing.evaluation.pictures)
    EXPECT_EQ(row.seconds > 0, row.technique != "oracle") << row.technique << row.stage;
  EXPECT_EQ(drawing.changing(), std::vector<std::string>());
}

/// Threads that share a set of maps only read it.
TEST(EvaluatePictures, SharedMapsAreBakedByOneThreadOnOneBackend) {
  for (const char* technique : {"quadrant_maxima", "oracle"}) {
    Drawing drawing;
    Registry registry = test::registry();
    registry.stages.erase("vertex");  // which needs what `surface` needs
    drawing.input.registry = &registry;
    drawing.input.techniques = {technique};
    drawing.input.baked = std::make_shared<BakedMaps>(true);
    Progress progress("pictures", 1);
    const Status drawn = evaluate_pictures(drawing.input, drawing.backends, drawing.evaluation, progress);
    ASSERT_TRUE(drawn) << format(drawn.error());
    EXPECT_EQ(drawing.watched["opengl"]->baking_threads, std::set{std::this_thread::get_id()}) << technique;
    EXPECT_TRUE(drawing.watched["vulkan"]->baking_threads.empty()) << technique;
  }
}

TEST(EvaluatePictures, OneThatChangesIsFound) {
  for (const bool time : {false, true}) {
    Drawing drawing;
    drawing.input.repeats = 3;
    drawing.input.time = time;
    drawing.watched["opengl"]->altered_size = 3 * 7;
    drawing.watched["opengl"]->altered = 2 * 7 + 4;  // in the last round, after three of prism and one of surface
    const Status drawn = drawing.run();
    ASSERT_TRUE(drawn) << format(drawn.error());
    EXPECT_EQ(drawing.changing(), std::vector<std::string>{"surface parallax opengl"});
    for (const PictureRow& row : drawing.evaluation.pictures)
      EXPECT_EQ(row.seconds > 0, time && row.technique != "oracle") << row.technique << row.stage;
  }
}

TEST(EvaluatePictures, TheErrorOfAnyJobComesOut) {
  for (const bool time : {false, true}) {
    Drawing drawing;
    drawing.input.techniques = {"bump"};
    drawing.input.repeats = 2;
    drawing.input.time = time;
    ASSERT_TRUE(drawing.run());
    std::map<std::string, int> jobs_of_all;
    for (const auto& [name, backend] : drawing.watched) jobs_of_all[name] = backend->jobs;
    for (const auto& [name, backend] : drawing.watched) {
      const int jobs = jobs_of_all[name];
      ASSERT_GT(jobs, 5);
      for (int failing = 1; failing <= jobs; ++failing) {
        backend->jobs = 0;
        backend->failing_job = failing;
        drawing.evaluation = {};
        drawing.input.baked = std::make_shared<BakedMaps>();
        const Status drawn = drawing.run();
        ASSERT_FALSE(drawn) << "job " << failing << " of " << jobs << " on " << name;
        EXPECT_EQ(drawn.error().id, "test.lost");
      }
      backend->failing_job = -1;
    }
  }
}

TEST(EvaluatePictures, OfTheOracleItselfNeedNoMap) {
  Drawing drawing;
  drawing.input.techniques = {"oracle"};
  const Status drawn = drawing.run();
  ASSERT_TRUE(drawn) << format(drawn.error());
  int judged = 0;
  for (const PictureAgreement& a : drawing.evaluation.picture_agreements) {
    if (a.right != "oracle" || a.technique != "oracle") continue;
    ++judged;
    EXPECT_EQ(a.difference.largest, 0) << a.stage;
  }
  EXPECT_EQ(judged, 4) << "two stages on two backends";
}

TEST(EvaluatePictures, OfOneBackendAndNoTechniques) {
  Drawing drawing;
  drawing.input.techniques.clear();
  drawing.backends.erase("opengl");
  const Status drawn = drawing.run();
  ASSERT_TRUE(drawn) << format(drawn.error());
  EXPECT_EQ(drawing.evaluation.pictures.size(), 3U) << "the oracle's two, and the mesh's own";
}

}  // namespace
}  // namespace relievo::cli
