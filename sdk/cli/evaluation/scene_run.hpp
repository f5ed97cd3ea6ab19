/// One scene on one backend, drawn in batches: what pictures and cracks share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <future>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "relievo/render.hpp"

namespace relievo::cli {

using Pixels = std::vector<std::uint8_t>;
using PicturesByCase = std::map<std::pair<std::string, std::string>, Pixels>;  // stage, technique

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

/// Runs of several backends may be drawn at once, since drivers compile on one thread each.
struct SceneRun {
  const EvaluationInput& input;
  const std::string& scene_name;
  const LoadedScene& parts;
  Backend& backend;
  MapSet& maps;
  bool first_backend;
  Evaluation evaluation = {};  ///< the rows of this run
  PicturesByCase pictures = {};
  Background background = {};  ///< last: it waits before what it works on is gone
};

/// Cases of `each` pictures that one Job draws.
std::size_t pictures_at_once(const SceneRun& run, std::size_t each = 1);

/// The input's techniques that draw silhouettes.
std::vector<std::string> techniques_with_silhouettes(const SceneRun& run);

/// With the exact filter.
RenderRequest request_of(const SceneRun& run, const std::string& stage, const std::string& technique, Aov aov);

Result<std::vector<RenderResult>> draw(SceneRun& run, std::span<const Mesh> meshes,
                                       std::span<const RenderRequest> requests);
/// Of the scene's own mesh.
Result<std::vector<RenderResult>> draw(SceneRun& run, std::span<const RenderRequest> requests);

/// Counts cracks between prisms, under random vertex orders, against the picture of the finely displaced mesh.
Status find_cracks(SceneRun& run);

/// Calls `work` with at most `most` of them at a time, until it fails.
template <class T, class Work>
Status in_batches(std::span<T> all, std::size_t most, const Work& work) {
  while (!all.empty()) {
    const std::size_t count = std::min(all.size(), most);
    if (Status status = work(all.first(count)); !status) return status;
    all = all.subspan(count);
  }
  return {};
}

}  // namespace relievo::cli
