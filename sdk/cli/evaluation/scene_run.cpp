#include "evaluation/scene_run.hpp"

namespace relievo::cli {

std::size_t pictures_at_once(const SceneRun& run, std::size_t each) {
  const SceneImage& size = run.parts.scene.image;
  const std::size_t pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  return std::max<std::size_t>(1, run.input.pixels_at_once / std::max<std::size_t>(1, pixels * each));
}

std::vector<std::string> techniques_with_silhouettes(const SceneRun& run) {
  std::vector<std::string> techniques = run.input.techniques;
  std::erase_if(techniques, [&](const std::string& name) { return !holds_silhouette(*run.input.registry, name); });
  return techniques;
}

RenderRequest request_of(const SceneRun& run, const std::string& stage, const std::string& technique, Aov aov) {
  return {stage, technique, HeightFilter::exact, aov, run.input.values};
}

Result<std::vector<RenderResult>> draw(SceneRun& run, std::span<const Mesh> meshes,
                                       std::span<const RenderRequest> requests) {
  return render(run.backend, *run.input.registry, run.parts.scene, meshes, run.maps, requests,
                &run.evaluation.messages);
}

Result<std::vector<RenderResult>> draw(SceneRun& run, std::span<const RenderRequest> requests) {
  return draw(run, {&run.parts.mesh, 1}, requests);
}

}  // namespace relievo::cli
