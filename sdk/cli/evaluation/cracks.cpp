/// Cracks between prisms: pictures under random vertex orders against the finely displaced mesh.
#include <fmt/format.h>
#include <span>

#include "evaluation/scene_run.hpp"
#include "relievo/measure.hpp"
#include "relievo/mesh.hpp"

namespace relievo::cli {

Status find_cracks(SceneRun& run) {
  const auto displaced = run.pictures.find({"vertex", ""});
  const bool draws_prisms =
      run.input.registry->stages.contains("prism") && run.backend.info().features.contains("geometry");
  const std::vector<std::string> techniques = techniques_with_silhouettes(run);
  if (!draws_prisms || techniques.empty()) return {};
  if (displaced == run.pictures.end()) {
    run.evaluation.not_run.push_back({fmt::format("cracks of scene {} on {}", run.scene_name, run.backend.info().name),
                                      "there is no picture of the finely displaced mesh"});
    return {};
  }
  std::vector<Mesh> shuffled;
  for (std::uint64_t seed = 1; seed <= run.input.crack_seeds; ++seed) shuffled.push_back(shuffle(run.parts.mesh, seed));
  const std::size_t at_once = pictures_at_once(run, shuffled.size());
  return in_batches(std::span<const std::string>(techniques), at_once, [&](std::span<const std::string> some) {
    std::vector<RenderRequest> requests;
    for (const std::string& technique : some) requests.push_back(request_of(run, "prism", technique, Aov::color));
    Result<std::vector<RenderResult>> drawn = draw(run, shuffled, requests);
    if (!drawn) return Status(tl::unexpected(drawn.error()));
    const SceneImage& size = run.parts.scene.image;
    for (std::size_t k = 0; k < some.size(); ++k) {
      for (std::size_t m = 0; m < shuffled.size(); ++m) {
        const Pixels& pixels = (*drawn)[m * some.size() + k].color;
        run.evaluation.cracks.push_back({run.scene_name, some[k], run.backend.info().name, m + 1,
                                         count_cracks(pixels, displaced->second, size.width, size.height)});
      }
    }
    return Status();
  });
}

}  // namespace relievo::cli
