/// The drawing stages: pictures per backend, repeated, against each other, the oracle and the finely displaced mesh.
#include <fmt/format.h>
#include <optional>
#include <span>

#include "evaluation/evaluation.hpp"
#include "evaluation/ramp.hpp"
#include "relievo/image.hpp"

namespace relievo::cli {

namespace {

using Pixels = std::vector<std::uint8_t>;

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

Result<RenderResult> draw(SceneRun& run, const std::string& stage, const std::string& technique, Aov aov = Aov::color) {
  RenderRequest request{stage, technique, HeightFilter::exact, aov, run.input.values};
  return render(run.backend, *run.input.registry, run.parts.scene, run.parts.mesh, run.maps, request,
                &run.evaluation.messages);
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

/// Draws `repeats` times, writes the picture and its row.
Result<Pixels> run_picture(SceneRun& run, const std::string& stage, const std::string& technique) {
  Result<RenderResult> first = draw(run, stage, technique);
  if (!first) return tl::unexpected(first.error());
  PictureRow row{
      run.scene_name, stage, technique, run.backend.info().name, "", "", "", -1, true, first->degenerate_triangles};
  std::vector<double> seconds = {first->seconds};
  for (int i = 1; i < run.input.repeats; ++i) {
    Result<RenderResult> again = draw(run, stage, technique);
    if (!again) return tl::unexpected(again.error());
    row.repeatable = row.repeatable && again->color == first->color;
    seconds.push_back(again->seconds);
  }
  if (seconds.size() > 1) seconds.erase(seconds.begin());  // drivers compile what they draw first
  row.seconds = median(seconds);
  if (!run.input.pictures.empty()) row.file = file_name(run, stage, technique);
  if (Status status = write_picture(run, file_name(run, stage, technique), first->color); !status)
    return tl::unexpected(status.error());
  run.evaluation.pictures.push_back(std::move(row));
  return std::move(first->color);
}

/// The picture to hold a stage's pictures against on the same backend, by name.
struct Reference {
  std::string name;
  Pixels pixels;
  std::optional<Image> surface;  ///< the surface point that each pixel shows
};

Status compare_with(SceneRun& run, const Reference& reference, const std::string& stage, const std::string& technique,
                    const Pixels& pixels) {
  const SceneImage& size = run.parts.scene.image;
  FlipDifference flipped = flip(pixels, reference.pixels, size.width, size.height);
  PictureAgreement agreement{run.scene_name, stage,
                             technique,      run.backend.info().name,
                             reference.name, compare_images(pixels, reference.pixels),
                             flipped.mean,   std::nullopt};
  if (reference.surface) {
    Result<RenderResult> surface = draw(run, stage, technique, Aov::uv);
    if (!surface) return tl::unexpected(surface.error());
    agreement.offsets = pixel_offsets(*reference.surface, surface->image);
  }
  run.evaluation.picture_agreements.push_back(std::move(agreement));
  if (run.input.pictures.empty()) return {};
  std::string flip_file = file_name(run, stage, technique, "-flip");
  run.evaluation.pictures.back().flip_file = flip_file;
  if (Status status = write_flip(run, flip_file, flipped.map); !status) return status;
  std::string file = file_name(run, stage, technique, "-difference");
  run.evaluation.pictures.back().difference_file = file;
  return write_picture(run, file, amplify_difference(pixels, reference.pixels));
}

/// Whether the oracle has a picture of the stage.
bool is_replayed(const StageDescriptor& stage) {
  return stage.mesh == "base" || stage.mesh == "prisms";
}

/// The oracle's picture of the stage; of a tessellated mesh, the oracle's picture of the prisms, which describe the
/// same surface.
Result<std::optional<Reference>> reference_for(SceneRun& run, const StageDescriptor& stage) {
  std::string drawn_by = is_replayed(stage) ? stage.name : "prism";
  if (!run.input.registry->stages.contains(drawn_by) || !run.backend.info().features.contains("geometry"))
    return std::nullopt;
  Result<RenderResult> result = draw(run, drawn_by, "oracle");
  if (!result) return tl::unexpected(result.error());
  if (is_replayed(stage)) {
    PictureRow row{run.scene_name, stage.name, "oracle", run.backend.info().name, "", "", "", -1, true, 0};
    if (!run.input.pictures.empty()) row.file = file_name(run, stage.name, "oracle");
    run.evaluation.pictures.push_back(std::move(row));
    if (Status status = write_picture(run, file_name(run, stage.name, "oracle"), result->color); !status)
      return tl::unexpected(status.error());
  }
  Reference reference{"oracle", std::move(result->color), std::nullopt};
  if (run.first_backend) {
    Result<RenderResult> surface = draw(run, drawn_by, "oracle", Aov::uv);
    if (!surface) return tl::unexpected(surface.error());
    reference.surface = std::move(surface->image);
  }
  return reference;
}

using PicturesByCase = std::map<std::pair<std::string, std::string>, Pixels>;  // stage, technique

Status run_stage(SceneRun& run, const StageDescriptor& stage, PicturesByCase& pictures) {
  for (const std::string& feature : stage.features) {
    if (run.backend.info().features.contains(feature)) continue;
    run.evaluation.not_run.push_back(
        {fmt::format("stage {} of scene {} on {}", stage.name, run.scene_name, run.backend.info().name),
         fmt::format("the driver lacks the feature '{}'", feature)});
    return {};
  }
  Result<std::optional<Reference>> reference = reference_for(run, stage);
  if (!reference) return tl::unexpected(reference.error());
  std::vector<std::string> techniques = stage.roles.empty() ? std::vector<std::string>{""} : run.input.techniques;
  for (const std::string& technique : techniques) {
    Result<Pixels> pixels = run_picture(run, stage.name, technique);
    if (!pixels) return tl::unexpected(pixels.error());
    if (*reference) {
      if (Status status = compare_with(run, **reference, stage.name, technique, *pixels); !status) return status;
    }
    pictures[{stage.name, technique}] = std::move(*pixels);
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
      for (const auto& [stage_name, stage] : input.registry->stages) {
        if (stage.mesh == "none") continue;
        progress.advance(fmt::format("pictures {} {} {}", name, stage_name, backend_name));
        if (Status status = run_stage(run, stage, by_backend[backend_name]); !status) return status;
      }
      compare_silhouettes(name, backend_name, by_backend[backend_name], evaluation);
    }
    compare_backends(name, by_backend, evaluation);
  }
  return {};
}

namespace {

constexpr std::uint64_t crack_seeds = 3;

/// Of a technique's prisms, under all random vertex orders.
Status count_scene_cracks(SceneRun& run, std::span<const Mesh> shuffled, const Pixels& reference,
                          const std::string& technique) {
  RenderRequest request{"prism", technique, HeightFilter::exact, Aov::color, run.input.values};
  Result<std::vector<RenderResult>> drawn =
      render(run.backend, *run.input.registry, run.parts.scene, shuffled, run.maps, request, &run.evaluation.messages);
  if (!drawn) return tl::unexpected(drawn.error());
  const SceneImage& size = run.parts.scene.image;
  for (std::size_t k = 0; k < drawn->size(); ++k) {
    run.evaluation.cracks.push_back({run.scene_name, technique, run.backend.info().name, k + 1,
                                     count_cracks((*drawn)[k].color, reference, size.width, size.height)});
  }
  return {};
}

}  // namespace

Status evaluate_cracks(const EvaluationInput& input, OpenBackends& backends, Evaluation& evaluation,
                       Progress& progress) {
  auto stage = input.registry->stages.find("prism");
  if (stage == input.registry->stages.end()) return {};
  for (const auto& [name, parts] : input.scenes) {
    std::vector<Mesh> shuffled;
    for (std::uint64_t seed = 1; seed <= crack_seeds; ++seed) shuffled.push_back(shuffle(parts.mesh, seed));
    for (auto& [backend_name, backend] : backends) {
      if (!backend->info().features.contains("geometry")) continue;
      progress.advance(fmt::format("cracks {} {}", name, backend_name));
      MapSet& maps = input.baked->of(*input.registry, parts.height, backend_name, input.values);
      SceneRun run{input, name, parts, *backend, maps, evaluation, false};
      Result<RenderResult> reference = draw(run, "vertex", "");
      if (!reference) return tl::unexpected(reference.error());
      for (const std::string& technique : input.techniques) {
        if (!holds_silhouette(*input.registry, technique)) continue;
        if (Status status = count_scene_cracks(run, shuffled, reference->color, technique); !status) return status;
      }
    }
  }
  return {};
}

}  // namespace relievo::cli
