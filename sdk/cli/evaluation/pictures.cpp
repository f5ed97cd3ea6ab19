/// The drawing stages: pictures per backend, repeated, against each other, the oracle and the finely displaced mesh.
#include <fmt/format.h>
#include <algorithm>
#include <future>
#include <memory>
#include <optional>
#include <span>

#include "evaluation/evaluation.hpp"
#include "evaluation/ramp.hpp"
#include "relievo/image.hpp"

namespace relievo::cli {

namespace {

using Pixels = std::vector<std::uint8_t>;

/// Pictures of one Job have no more pixels together, which bounds what they take in memory; fewer Jobs upload maps less
/// often.
constexpr std::size_t most_pixels_at_once = std::size_t{1} << 23;

std::size_t pictures_at_once(const SceneImage& size) {
  const std::size_t pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  return std::max<std::size_t>(1, most_pixels_at_once / pixels);
}

/// Work beside the drawing, one piece after another: drivers leave processors idle while we compare and compress.
class Background {
 public:
  /// Starts `work` when what was started before is done, and tells how that went.
  template <class Work>
  Status start(Work work) {
    Status before = wait();
    if (before) pending_ = std::async(std::launch::async, std::move(work));
    return before;
  }
  Status wait() { return pending_.valid() ? pending_.get() : Status(); }

 private:
  std::future<Status> pending_;
};

/// Everything that one scene needs on one backend; maps are baked once.
struct SceneRun {
  const EvaluationInput& input;
  const std::string& scene_name;
  const LoadedScene& parts;
  Backend& backend;
  MapSet& maps;
  Evaluation& evaluation;
  bool first_backend;
};

std::vector<RenderRequest> requests_of(const SceneRun& run, const std::string& stage,
                                       std::span<const std::string> techniques, Aov aov) {
  std::vector<RenderRequest> requests;
  for (const std::string& technique : techniques)
    requests.push_back({stage, technique, HeightFilter::exact, aov, run.input.values});
  return requests;
}

Result<std::vector<RenderResult>> draw(SceneRun& run, std::span<const Mesh> meshes,
                                       std::span<const RenderRequest> requests) {
  return render(run.backend, *run.input.registry, run.parts.scene, meshes, run.maps, requests,
                &run.evaluation.messages);
}

Result<std::vector<RenderResult>> draw(SceneRun& run, std::span<const RenderRequest> requests) {
  return draw(run, {&run.parts.mesh, 1}, requests);
}

std::string file_name(const SceneRun& run, const std::string& stage, const std::string& technique,
                      const char* suffix = "") {
  return fmt::format("{}-{}{}{}-{}{}.png", run.scene_name, stage, technique.empty() ? "" : "-", technique,
                     run.backend.info().name, suffix);
}

Status write_picture(const SceneRun& run, const std::string& file, const Pixels& pixels) {
  if (run.input.pictures.empty()) return {};
  return write_png(run.input.pictures / file, run.parts.scene.image.width, run.parts.scene.image.height, 4, pixels);
}

/// |a − b| eightfold on black: what differs by a little is seen.
Pixels amplify_difference(const Pixels& a, const Pixels& b) {
  Pixels result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    int difference = 8 * std::abs(static_cast<int>(a[i]) - static_cast<int>(b[i]));
    result[i] = i % 4 == 3 ? std::uint8_t{255} : static_cast<std::uint8_t>(std::min(difference, 255));
  }
  return result;
}

Status write_flip(const SceneRun& run, const std::string& file, const std::vector<float>& map) {
  Pixels pixels;
  for (float value : map) {
    RampColor color = ramp(value);
    pixels.insert(pixels.end(), color.begin(), color.end());
    pixels.push_back(255);
  }
  return write_picture(run, file, pixels);
}

/// The picture to hold a stage's pictures against on the same backend, by name.
struct Reference {
  std::string name;
  Pixels pixels;
  std::optional<Image> surface;  ///< the surface point that each pixel shows
};

/// A technique's picture of a stage, before it is held against others.
struct Picture {
  PictureRow row;
  Pixels pixels;
  std::optional<Image> surface;  ///< where the reference has one
};

/// Draws the pictures of some techniques, each run of all of them at once, and times all runs but the first: drivers
/// compile what they draw first.
Result<std::vector<Picture>> draw_pictures(SceneRun& run, const std::string& stage,
                                           std::span<const std::string> techniques, bool with_surfaces) {
  const std::vector<RenderRequest> requests = requests_of(run, stage, techniques, Aov::color);
  std::vector<Picture> pictures;
  std::vector<std::vector<double>> seconds(requests.size());
  for (int i = 0; i < run.input.repeats; ++i) {
    Result<std::vector<RenderResult>> drawn = draw(run, requests);
    if (!drawn) return tl::unexpected(drawn.error());
    for (std::size_t k = 0; k < requests.size(); ++k) {
      RenderResult& one = (*drawn)[k];
      if (i == 0) {
        PictureRow row{run.scene_name, stage, techniques[k], run.backend.info().name, "", "", "", -1, true,
                       one.degenerate_triangles};
        pictures.push_back({std::move(row), std::move(one.color), std::nullopt});
        continue;
      }
      PictureRow& row = pictures[k].row;
      row.repeatable = row.repeatable && one.color == pictures[k].pixels;
      seconds[k].push_back(one.seconds);
    }
  }
  for (std::size_t k = 0; k < pictures.size(); ++k) pictures[k].row.seconds = median(seconds[k]);
  if (!with_surfaces) return pictures;
  Result<std::vector<RenderResult>> surfaces = draw(run, requests_of(run, stage, techniques, Aov::uv));
  if (!surfaces) return tl::unexpected(surfaces.error());
  for (std::size_t k = 0; k < pictures.size(); ++k) pictures[k].surface = std::move((*surfaces)[k].image);
  return pictures;
}

/// Holds a picture against the reference, and writes how they differ.
Status compare_with(const SceneRun& run, const Reference& reference, Picture& picture) {
  PictureRow& row = picture.row;
  const SceneImage& size = run.parts.scene.image;
  FlipDifference flipped = flip(picture.pixels, reference.pixels, size.width, size.height);
  PictureAgreement agreement{row.scene,      row.stage,
                             row.technique,  row.backend,
                             reference.name, compare_images(picture.pixels, reference.pixels),
                             flipped.mean,   std::nullopt};
  if (reference.surface && picture.surface) agreement.offsets = pixel_offsets(*reference.surface, *picture.surface);
  run.evaluation.picture_agreements.push_back(std::move(agreement));
  if (run.input.pictures.empty()) return {};
  row.flip_file = file_name(run, row.stage, row.technique, "-flip");
  if (Status status = write_flip(run, row.flip_file, flipped.map); !status) return status;
  row.difference_file = file_name(run, row.stage, row.technique, "-difference");
  return write_picture(run, row.difference_file, amplify_difference(picture.pixels, reference.pixels));
}

using PicturesByCase = std::map<std::pair<std::string, std::string>, Pixels>;  // stage, technique

/// Writes a picture and its row, and keeps its pixels for other comparisons.
Status finish_picture(const SceneRun& run, const std::optional<Reference>& reference, Picture& picture,
                      PicturesByCase& pictures) {
  PictureRow& row = picture.row;
  if (!run.input.pictures.empty()) row.file = file_name(run, row.stage, row.technique);
  if (Status status = write_picture(run, row.file, picture.pixels); !status) return status;
  if (reference) {
    if (Status status = compare_with(run, *reference, picture); !status) return status;
  }
  pictures[{row.stage, row.technique}] = std::move(picture.pixels);
  run.evaluation.pictures.push_back(std::move(row));
  return {};
}

/// Whether the oracle has a picture of the stage.
bool is_replayed(const StageDescriptor& stage) {
  return stage.mesh == "base" || stage.mesh == "prisms";
}

/// The oracle's picture of the stage; of a tessellated mesh, the oracle's picture of the prisms, which describe the
/// same surface.
Result<std::optional<Reference>> reference_for(SceneRun& run, const StageDescriptor& stage) {
  const std::string drawn_by = is_replayed(stage) ? stage.name : "prism", oracle = "oracle";
  if (!run.input.registry->stages.contains(drawn_by) || !run.backend.info().features.contains("geometry"))
    return std::nullopt;
  std::vector<RenderRequest> requests = requests_of(run, drawn_by, {&oracle, 1}, Aov::color);
  if (run.first_backend) {
    requests.push_back(requests.front());
    requests.back().aov = Aov::uv;
  }
  Result<std::vector<RenderResult>> drawn = draw(run, requests);
  if (!drawn) return tl::unexpected(drawn.error());
  Reference reference{oracle, std::move(drawn->front().color), std::nullopt};
  if (run.first_backend) reference.surface = std::move(drawn->back().image);
  return reference;
}

/// Writes the oracle's picture and its row.
Status finish_reference(const SceneRun& run, const std::string& stage, const Reference& reference) {
  PictureRow row{run.scene_name, stage, reference.name, run.backend.info().name, "", "", "", -1, true, 0};
  if (!run.input.pictures.empty()) row.file = file_name(run, stage, reference.name);
  if (Status status = write_picture(run, row.file, reference.pixels); !status) return status;
  run.evaluation.pictures.push_back(std::move(row));
  return {};
}

Status run_stage(SceneRun& run, const StageDescriptor& stage, PicturesByCase& pictures, Background& background) {
  for (const std::string& feature : stage.features) {
    if (run.backend.info().features.contains(feature)) continue;
    run.evaluation.not_run.push_back(
        {fmt::format("stage {} of scene {} on {}", stage.name, run.scene_name, run.backend.info().name),
         fmt::format("the driver lacks the feature '{}'", feature)});
    return {};
  }
  Result<std::optional<Reference>> made = reference_for(run, stage);
  if (!made) return tl::unexpected(made.error());
  const auto reference = std::make_shared<const std::optional<Reference>>(*std::move(made));
  if (*reference && is_replayed(stage)) {
    const auto finish = [&run, &stage, reference] { return finish_reference(run, stage.name, **reference); };
    if (Status status = background.start(finish); !status) return status;
  }
  const bool with_surfaces = *reference && (*reference)->surface;
  const std::vector<std::string> nothing_traced = {""};
  std::span<const std::string> left = stage.roles.empty() ? nothing_traced : run.input.techniques;
  while (!left.empty()) {
    const std::size_t count = std::min(left.size(), pictures_at_once(run.parts.scene.image));
    Result<std::vector<Picture>> drawn = draw_pictures(run, stage.name, left.first(count), with_surfaces);
    if (!drawn) return tl::unexpected(drawn.error());
    auto finish = [&run, &pictures, reference, some = *std::move(drawn)]() mutable -> Status {
      for (Picture& picture : some) {
        if (Status status = finish_picture(run, *reference, picture, pictures); !status) return status;
      }
      return {};
    };
    if (Status status = background.start(std::move(finish)); !status) return status;
    left = left.subspan(count);
  }
  return {};
}

/// Silhouettes: every picture of the prisms against the finely displaced mesh.
void compare_silhouettes(const std::string& scene, const std::string& backend, const PicturesByCase& pictures,
                         Evaluation& evaluation) {
  auto displaced = pictures.find({"vertex", ""});
  if (displaced == pictures.end()) return;
  for (const auto& [key, pixels] : pictures) {
    if (key.first != "prism") continue;
    evaluation.picture_agreements.push_back(
        {scene, key.first, key.second, backend, "vertex", compare_images(pixels, displaced->second), -1, {}});
  }
}

void compare_backends(const std::string& scene, const std::map<std::string, PicturesByCase>& by_backend,
                      Evaluation& evaluation) {
  if (by_backend.size() < 2) return;
  const auto& [left, first] = *by_backend.begin();
  for (auto other = std::next(by_backend.begin()); other != by_backend.end(); ++other) {
    for (const auto& [key, pixels] : first) {
      auto match = other->second.find(key);
      if (match == other->second.end()) continue;
      evaluation.picture_agreements.push_back(
          {scene, key.first, key.second, left, other->first, compare_images(pixels, match->second), -1, {}});
    }
  }
}

}  // namespace

Status evaluate_pictures(const EvaluationInput& input, OpenBackends& backends, Evaluation& evaluation,
                         Progress& progress) {
  for (const auto& [name, parts] : input.scenes) {
    std::map<std::string, PicturesByCase> by_backend;
    for (auto& [backend_name, backend] : backends) {
      MapSet& maps = input.baked->of(*input.registry, parts.height, backend_name, input.values);
      SceneRun run{input, name, parts, *backend, maps, evaluation, backend_name == backends.begin()->first};
      Background background;
      for (const auto& [stage_name, stage] : input.registry->stages) {
        if (stage.mesh == "none") continue;
        progress.advance(fmt::format("pictures {} {} {}", name, stage_name, backend_name));
        if (Status status = run_stage(run, stage, by_backend[backend_name], background); !status) return status;
      }
      if (Status status = background.wait(); !status) return status;
      compare_silhouettes(name, backend_name, by_backend[backend_name], evaluation);
    }
    compare_backends(name, by_backend, evaluation);
  }
  return {};
}

namespace {

/// Of the techniques' prisms, under all random vertex orders.
Status count_scene_cracks(SceneRun& run, std::span<const Mesh> shuffled, const Pixels& reference,
                          std::span<const std::string> techniques) {
  Result<std::vector<RenderResult>> drawn = draw(run, shuffled, requests_of(run, "prism", techniques, Aov::color));
  if (!drawn) return tl::unexpected(drawn.error());
  const SceneImage& size = run.parts.scene.image;
  for (std::size_t i = 0; i < drawn->size(); ++i) {
    const std::size_t seed = 1 + i / techniques.size();
    run.evaluation.cracks.push_back({run.scene_name, techniques[i % techniques.size()], run.backend.info().name, seed,
                                     count_cracks((*drawn)[i].color, reference, size.width, size.height)});
  }
  return {};
}

}  // namespace

Status evaluate_cracks(const EvaluationInput& input, OpenBackends& backends, Evaluation& evaluation,
                       Progress& progress) {
  auto stage = input.registry->stages.find("prism");
  if (stage == input.registry->stages.end()) return {};
  std::vector<std::string> techniques = input.techniques;
  std::erase_if(techniques, [&](const std::string& name) { return !holds_silhouette(*input.registry, name); });
  for (const auto& [name, parts] : input.scenes) {
    std::vector<Mesh> shuffled;
    for (std::uint64_t seed = 1; seed <= input.crack_seeds; ++seed) shuffled.push_back(shuffle(parts.mesh, seed));
    for (auto& [backend_name, backend] : backends) {
      if (!backend->info().features.contains("geometry")) continue;
      progress.advance(fmt::format("cracks {} {}", name, backend_name));
      MapSet& maps = input.baked->of(*input.registry, parts.height, backend_name, input.values);
      SceneRun run{input, name, parts, *backend, maps, evaluation, false};
      const RenderRequest displaced{"vertex", "", HeightFilter::exact, Aov::color, input.values};
      Result<std::vector<RenderResult>> reference = draw(run, {&displaced, 1});
      if (!reference) return tl::unexpected(reference.error());
      const std::size_t at_once =
          std::max<std::size_t>(1, pictures_at_once(parts.scene.image) / static_cast<std::size_t>(input.crack_seeds));
      for (std::span<const std::string> left = techniques; !left.empty();) {
        const std::size_t count = std::min(left.size(), at_once);
        Status status = count_scene_cracks(run, shuffled, reference->front().color, left.first(count));
        if (!status) return status;
        left = left.subspan(count);
      }
    }
  }
  return {};
}

}  // namespace relievo::cli
