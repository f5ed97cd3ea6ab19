/// The drawing stages: pictures per backend, repeated, against each other, the oracle and the finely displaced mesh.
#include <fmt/format.h>
#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <list>
#include <memory>
#include <optional>

#include "evaluation/at_once.hpp"
#include "evaluation/ramp.hpp"
#include "evaluation/scene_run.hpp"
#include "relievo/image.hpp"

namespace relievo::cli {

namespace {

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

/// Draws the pictures of some techniques all at once, and the surface points of those whose offsets are measured.
Result<std::vector<Picture>> draw_pictures(SceneRun& run, const std::string& stage,
                                           std::span<const std::string> techniques, bool with_surfaces) {
  std::vector<RenderRequest> requests;
  for (const std::string& technique : techniques) {
    requests.push_back(request_of(run, stage, technique, Aov::color));
    const bool has_offsets = run.input.all_pictures || always_finds_first_hit(*run.input.registry, technique);
    if (with_surfaces && has_offsets) requests.push_back(request_of(run, stage, technique, Aov::uv));
  }
  Result<std::vector<RenderResult>> drawn = draw(run, requests);
  if (!drawn) return tl::unexpected(drawn.error());
  std::vector<Picture> pictures;
  for (std::size_t k = 0; k < drawn->size(); ++k) {
    RenderResult& one = (*drawn)[k];
    if (requests[k].aov == Aov::uv) {
      pictures.back().surface = std::move(one.image);
      continue;
    }
    PictureRow row{run.scene_name,          stage, requests[k].technique, run.backend.info().name, "", "", "", -1, true,
                   one.degenerate_triangles};
    pictures.push_back({std::move(row), std::move(one.color), std::nullopt});
    one = {};  // pictures may be large
  }
  return pictures;
}

/// Holds a picture against the reference, and writes how they differ.
Status compare_with(SceneRun& run, const Reference& reference, Picture& picture) {
  PictureRow& row = picture.row;
  const SceneImage& size = run.parts.scene.image;
  FlipDifference flipped = flip(picture.pixels, reference.pixels, size.width, size.height);
  PictureAgreement agreement{row.scene,    row.stage,      row.technique,
                             row.backend,  reference.name, compare_images(picture.pixels, reference.pixels),
                             flipped.mean, std::nullopt};
  if (reference.surface && picture.surface) agreement.offsets = pixel_offsets(*reference.surface, *picture.surface);
  run.evaluation.picture_agreements.push_back(std::move(agreement));
  if (run.input.pictures.empty()) return {};
  row.flip_file = file_name(run, row.stage, row.technique, "-flip");
  if (Status status = write_flip(run, row.flip_file, flipped.map); !status) return status;
  row.difference_file = file_name(run, row.stage, row.technique, "-difference");
  return write_picture(run, row.difference_file, amplify_difference(picture.pixels, reference.pixels));
}

/// Writes a picture and its row, and keeps its pixels for other comparisons.
Status finish_picture(SceneRun& run, const std::optional<Reference>& reference, Picture& picture) {
  PictureRow& row = picture.row;
  if (!run.input.pictures.empty()) row.file = file_name(run, row.stage, row.technique);
  if (Status status = write_picture(run, row.file, picture.pixels); !status) return status;
  if (reference) {
    if (Status status = compare_with(run, *reference, picture); !status) return status;
  }
  run.pictures[{row.stage, row.technique}] = std::move(picture.pixels);
  run.evaluation.pictures.push_back(std::move(row));
  return {};
}

/// The technique whose pictures others are held against.
const std::string replayed = "oracle";

/// Whether the oracle has a picture of the stage.
bool is_replayed(const StageDescriptor& stage) {
  return stage.mesh == "base" || stage.mesh == "prisms";
}

/// The oracle's picture of the stage; of a tessellated mesh, the oracle's picture of the prisms, which describe the
/// same surface.
Result<std::optional<Reference>> reference_for(SceneRun& run, const StageDescriptor& stage) {
  const std::string drawn_by = is_replayed(stage) ? stage.name : "prism";
  if (!run.input.registry->stages.contains(drawn_by) || !run.backend.info().features.contains("geometry"))
    return std::nullopt;
  std::vector<RenderRequest> requests = {request_of(run, drawn_by, replayed, Aov::color)};
  if (run.first_backend) requests.push_back(request_of(run, drawn_by, replayed, Aov::uv));
  Result<std::vector<RenderResult>> drawn = draw(run, requests);
  if (!drawn) return tl::unexpected(drawn.error());
  Reference reference{replayed, std::move(drawn->front().color), std::nullopt};
  if (run.first_backend) reference.surface = std::move(drawn->back().image);
  return reference;
}

/// Writes the oracle's picture and its row.
Status finish_reference(SceneRun& run, const std::string& stage, const Reference& reference) {
  PictureRow row{run.scene_name, stage, reference.name, run.backend.info().name, "", "", "", -1, true, 0};
  if (!run.input.pictures.empty()) row.file = file_name(run, stage, reference.name);
  if (Status status = write_picture(run, row.file, reference.pixels); !status) return status;
  run.evaluation.pictures.push_back(std::move(row));
  return {};
}

/// What a stage is drawn with; nothing where it traces nothing.
std::vector<std::string> techniques_of(const SceneRun& run, const StageDescriptor& stage) {
  if (stage.roles.empty()) return {""};
  return stage.mesh == "prisms" && !run.input.all_pictures ? techniques_with_silhouettes(run) : run.input.techniques;
}

Status run_stage(SceneRun& run, const StageDescriptor& stage) {
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
    if (Status status = run.background.start(finish); !status) return status;
  }
  const bool with_surfaces = *reference && (*reference)->surface;
  const std::vector<std::string> techniques = techniques_of(run, stage);
  return in_batches(std::span(techniques), pictures_at_once(run, with_surfaces ? 2 : 1),
                    [&](std::span<const std::string> some) -> Status {
                      Result<std::vector<Picture>> drawn = draw_pictures(run, stage.name, some, with_surfaces);
                      if (!drawn) return tl::unexpected(drawn.error());
                      return run.background.start([&run, reference, pictures = *std::move(drawn)]() mutable -> Status {
                        for (Picture& picture : pictures) {
                          if (Status status = finish_picture(run, *reference, picture); !status) return status;
                        }
                        return {};
                      });
                    });
}

/// Draws pictures again in rounds of one Job, to see whether they are the same, and adds what each round but the first
/// takes: drivers compile in that one.
Status draw_rounds(SceneRun& run, std::span<PictureRow* const> rows, std::size_t rounds,
                   std::vector<std::vector<double>>& seconds) {
  std::vector<RenderRequest> requests;
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const PictureRow* row : rows)
      requests.push_back({row->stage, row->technique, HeightFilter::exact, Aov::color, run.input.values});
  }
  Result<std::vector<RenderResult>> drawn = draw(run, requests);
  if (!drawn) return tl::unexpected(drawn.error());
  for (std::size_t i = 0; i < drawn->size(); ++i) {
    PictureRow& row = *rows[i % rows.size()];
    row.repeatable = row.repeatable && (*drawn)[i].color == run.pictures.at({row.stage, row.technique});
    if (i >= rows.size()) seconds[i % rows.size()].push_back((*drawn)[i].seconds);
  }
  return {};
}

Status draw_rows_again(SceneRun& run, std::span<PictureRow* const> rows) {
  const std::size_t timed_at_once = std::max<std::size_t>(2, pictures_at_once(run, rows.size())) - 1;
  std::vector<std::vector<double>> seconds(rows.size());
  for (auto left = static_cast<std::size_t>(run.input.repeats - 1); left > 0;) {
    const std::size_t timed = std::min(left, timed_at_once);
    if (Status status = draw_rounds(run, rows, timed + 1, seconds); !status) return status;
    left -= timed;
  }
  for (std::size_t k = 0; k < rows.size() && run.input.time; ++k) rows[k]->seconds = median(seconds[k]);
  return {};
}

/// All pictures but the oracle's.
Status draw_again(SceneRun& run) {
  std::vector<PictureRow*> rows;
  for (PictureRow& row : run.evaluation.pictures) {
    if (run.pictures.contains({row.stage, row.technique})) rows.push_back(&row);
  }
  const std::size_t at_once = pictures_at_once(run, static_cast<std::size_t>(run.input.repeats));
  return in_batches(std::span<PictureRow* const>(rows), at_once,
                    [&](std::span<PictureRow* const> some) { return draw_rows_again(run, some); });
}

/// Before runs share the maps: those of the stage, which the oracle's rays need too, and of the techniques.
Status bake_maps(SceneRun& run, const StageDescriptor& stage) {
  std::vector<std::string> techniques = techniques_of(run, stage);
  std::replace(techniques.begin(), techniques.end(), replayed, std::string());  // its map is made for each picture
  techniques.emplace_back();
  for (const std::string& technique : techniques) {
    Status status = bake_required_maps(run.backend, *run.input.registry, stage.name, technique, run.maps,
                                       run.input.values, &run.evaluation.messages);
    if (!status) return status;
  }
  return {};
}

using Stages = std::vector<const StageDescriptor*>;

Status draw_scene(SceneRun& run, const Stages& stages, Progress& progress) {
  for (const StageDescriptor* stage : stages) {
    progress.advance(fmt::format("pictures {} {} {}", run.scene_name, stage->name, run.backend.info().name));
    if (Status status = run_stage(run, *stage); !status) return status;
  }
  Status finished = run.background.wait();
  progress.advance(fmt::format("cracks {} {}", run.scene_name, run.backend.info().name));
  if (finished) finished = find_cracks(run);
  return finished && run.input.repeats > 1 && !run.input.time ? draw_again(run) : finished;
}

/// All backends at once; what is timed, one after another.
Status draw_on_all(std::list<SceneRun>& runs, const Stages& stages, Progress& progress) {
  for (SceneRun& run : runs) {
    for (const StageDescriptor* stage : stages) {
      if (Status status = bake_maps(run, *stage); !status) return status;
    }
  }
  Status drawn = for_each_at_once(runs, [&](SceneRun& run) { return draw_scene(run, stages, progress); });
  for (SceneRun& run : runs) {
    if (drawn && run.input.repeats > 1 && run.input.time) drawn = draw_again(run);
  }
  return drawn;
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

void compare_backends(const std::string& scene, const std::list<SceneRun>& runs, Evaluation& evaluation) {
  const SceneRun& left = runs.front();
  for (auto right = std::next(runs.begin()); right != runs.end(); ++right) {
    const std::string& other = right->backend.info().name;
    for (const auto& [key, pixels] : left.pictures) {
      auto match = right->pictures.find(key);
      if (match == right->pictures.end()) continue;
      evaluation.picture_agreements.push_back({scene, key.first, key.second, left.backend.info().name, other,
                                               compare_images(pixels, match->second), -1, std::nullopt});
    }
  }
}

}  // namespace

Status evaluate_pictures(const EvaluationInput& input, OpenBackends& backends, Evaluation& evaluation,
                         Progress& progress) {
  Stages stages;
  for (const auto& [name, stage] : input.registry->stages) {
    if (stage.mesh != "none") stages.push_back(&stage);
  }
  for (const auto& [name, parts] : input.scenes) {
    std::list<SceneRun> runs;
    for (auto& [backend_name, backend] : backends) {
      MapSet& maps = input.baked->of(*input.registry, parts.height, backend_name, input.values);
      runs.push_back({input, name, parts, *backend, maps, runs.empty()});
    }
    if (Status status = draw_on_all(runs, stages, progress); !status) return status;
    for (SceneRun& run : runs) {
      move_to(evaluation.pictures, run.evaluation.pictures);
      move_to(evaluation.picture_agreements, run.evaluation.picture_agreements);
      move_to(evaluation.cracks, run.evaluation.cracks);
      move_to(evaluation.messages, run.evaluation.messages);
      move_to(evaluation.not_run, run.evaluation.not_run);
      compare_silhouettes(name, run.backend.info().name, run.pictures, evaluation);
    }
    compare_backends(name, runs, evaluation);
  }
  if (input.repeats == 1 && !input.scenes.empty())
    evaluation.not_run.push_back({"pictures again, for their times and what changes", "1 repeat draws them once"});
  return {};
}

}  // namespace relievo::cli
