/// Cracks between prisms: pictures under random vertex orders against the finely displaced mesh.
#include <fmt/format.h>
#include <span>

#include "evaluation/scene_run.hpp"
#include "relievo/measure.hpp"
#include "relievo/mesh.hpp"

namespace relievo::cli {

namespace {

/// Of the techniques' prisms, under all random vertex orders.
Status count_scene_cracks(SceneRun& run, std::span<const Mesh> shuffled, const Pixels& reference,
                          std::span<const std::string> techniques) {
  Result<std::vector<RenderResult>> drawn = draw(run, shuffled, requests_of(run, "prism", techniques, Aov::color));
  if (!drawn) return tl::unexpected(drawn.error());
  const SceneImage& size = run.parts.scene.image;
  for (std::size_t k = 0; k < techniques.size(); ++k) {
    for (std::size_t m = 0; m < shuffled.size(); ++m) {
      const Pixels& pixels = (*drawn)[m * techniques.size() + k].color;
      run.evaluation.cracks.push_back({run.scene_name, techniques[k], run.backend.info().name, m + 1,
                                       count_cracks(pixels, reference, size.width, size.height)});
    }
  }
  return {};
}

}  // namespace

Status evaluate_cracks(const EvaluationInput& input, OpenBackends& backends, Evaluation& evaluation,
                       Progress& progress) {
  if (!input.registry->stages.contains("prism")) return {};
  std::vector<std::string> techniques = input.techniques;
  std::erase_if(techniques, [&](const std::string& name) { return !holds_silhouette(*input.registry, name); });
  for (const auto& [name, parts] : input.scenes) {
    std::vector<Mesh> shuffled;
    for (std::uint64_t seed = 1; seed <= input.crack_seeds; ++seed) shuffled.push_back(shuffle(parts.mesh, seed));
    for (auto& [backend_name, backend] : backends) {
      if (!backend->info().features.contains("geometry")) continue;
      progress.advance(fmt::format("cracks {} {}", name, backend_name));
      MapSet& maps = input.baked->of(*input.registry, parts.height, backend_name, input.values);
      SceneRun run{input, name, parts, *backend, maps, false};
      const RenderRequest displaced{"vertex", "", HeightFilter::exact, Aov::color, input.values};
      Result<std::vector<RenderResult>> reference = draw(run, {&displaced, 1});
      if (!reference) return tl::unexpected(reference.error());
      Status counted = in_batches(std::span<const std::string>(techniques), pictures_at_once(run, shuffled.size()),
                                  [&](std::span<const std::string> some) {
                                    return count_scene_cracks(run, shuffled, reference->front().color, some);
                                  });
      if (!counted) return counted;
      move_to(evaluation.cracks, run.evaluation.cracks);
      move_to(evaluation.messages, run.evaluation.messages);
    }
  }
  return {};
}

}  // namespace relievo::cli
