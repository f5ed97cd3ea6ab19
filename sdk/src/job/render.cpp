/// Pictures from a backend: baking, drawing, reading back.
#include <algorithm>
#include <cstring>

#include "job/oracle_picture.hpp"
#include "job/program.hpp"
#include "relievo/render.hpp"

namespace relievo {

namespace {

using Rendered = Result<std::vector<RenderResult>>;

Image to_image(const std::vector<std::byte>& bytes, const SceneImage& size, Aov aov) {
  Image image{size.width, size.height, 4, {}};
  std::size_t count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 4;
  image.pixels.resize(count);
  if (aov != Aov::color) {
    std::memcpy(image.pixels.data(), bytes.data(), count * sizeof(float));
    return image;
  }
  for (std::size_t i = 0; i < count; ++i)
    image.pixels[i] = static_cast<float>(static_cast<std::uint8_t>(bytes[i])) / 255.0f;
  return image;
}

RenderResult result_of(const std::vector<std::byte>& pixels, const SceneImage& size, Aov aov) {
  RenderResult rendered;
  rendered.image = to_image(pixels, size, aov);
  if (aov == Aov::color) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(pixels.data());
    rendered.color.assign(bytes, bytes + pixels.size());
  }
  return rendered;
}

std::uint64_t degenerate_triangles(const Mesh& mesh) {
  std::uint64_t count = 0;
  for (const TriangleFrame& frame : triangle_frames(mesh)) count += frame.degenerate;
  return count;
}

/// The pictures of a scene on a backend.
class Renderer {
 public:
  Renderer(Backend& backend, const Registry& registry, const Scene& scene, std::vector<std::string>* messages)
      : backend_(backend), registry_(registry), scene_(scene), messages_(messages) {}

  /// Of every mesh with every request, by one Job.
  Rendered draw(std::span<const Mesh> meshes, MapSet& maps, std::span<const RenderRequest> requests) {
    std::vector<RenderRequest> suited(requests.begin(), requests.end());
    for (RenderRequest& request : suited) {
      Status baked =
          bake_required_maps(backend_, registry_, request.stage, request.technique, maps, request.values, messages_);
      if (!baked) return tl::unexpected(baked.error());
      request.values = values_on(registry_, backend_.info(), std::move(request.values));
    }
    Result<Job> job = make_render_job(registry_, scene_, meshes, maps, suited, backend_.info().shader_target);
    if (!job) return tl::unexpected(job.error());
    Result<JobResult> result = backend_.execute(*job);
    if (!result) return tl::unexpected(result.error());
    append_messages(*result, messages_);
    std::vector<RenderResult> rendered;
    for (const Mesh& mesh : meshes) {
      const std::uint64_t degenerate = degenerate_triangles(mesh);
      for (const RenderRequest& request : requests) {
        const std::size_t k = rendered.size();
        rendered.push_back(result_of(result->read_backs.at(k), scene_.image, request.aov));
        result->read_backs[k] = {};  // pictures may be large
        rendered.back().degenerate_triangles = degenerate;
        if (!result->command_seconds.empty()) rendered.back().seconds = result->command_seconds[k];
      }
    }
    return rendered;
  }

  /// Computes the exact hits of the pixels on the CPU, then lets the stage replay them (techniques/oracle) for requests
  /// that differ in what they show.
  Rendered replay(const Mesh& mesh, MapSet& maps, std::span<const RenderRequest> requests) {
    const RenderRequest& request = requests.front();
    Result<MapData> hits = exact_hits(mesh, maps, request);
    if (!hits) return tl::unexpected(hits.error());
    MapSet with_hits;  // of the others, what the stage itself reads: maps may be large
    Result<std::vector<std::string>> needed = required_maps(registry_, request.stage, request.technique);
    if (!needed) return tl::unexpected(needed.error());
    for (const std::string& map : *needed) {
      if (const auto known = maps.find(map); known != maps.end()) with_hits.insert(*known);
    }
    with_hits.insert(*maps.find("height"));
    with_hits["oracle_hits"] = std::move(*hits);
    return draw({&mesh, 1}, with_hits, requests);
  }

 private:
  Result<MapData> exact_hits(const Mesh& mesh, MapSet& maps, const RenderRequest& request) {
    Result<const StageDescriptor*> stage = registry_.stage(request.stage);
    if (!stage) return tl::unexpected(stage.error());
    if ((*stage)->mesh == "base") return surface_hits(mesh, maps, request);
    if ((*stage)->mesh == "prisms") return exact_prism_hits(height_map_of(maps), scene_, mesh);
    return fail(ErrorCode::unsupported, "render.oracle-stage",
                "the oracle has no picture of stage '" + request.stage + "', which draws the mesh '" + (*stage)->mesh +
                    "'; expected 'base' or 'prisms'");
  }

  /// The rays of the pixels come from the stage itself, written as pictures.
  Result<MapData> surface_hits(const Mesh& mesh, MapSet& maps, const RenderRequest& request) {
    std::vector<RenderRequest> rays(2, request);
    for (RenderRequest& part : rays) part.technique = "bump";
    rays[0].aov = Aov::ray_origin;
    rays[1].aov = Aov::ray_direction;
    Rendered drawn = draw({&mesh, 1}, maps, rays);
    if (!drawn) return tl::unexpected(drawn.error());
    return exact_surface_hits(height_map_of(maps), (*drawn)[0].image, (*drawn)[1].image);
  }

  Backend& backend_;
  const Registry& registry_;
  const Scene& scene_;
  std::vector<std::string>* messages_;
};

/// Requests that one Job draws, by their places in the caller's list.
struct RequestGroup {
  std::vector<RenderRequest> requests;
  std::vector<std::size_t> places;

  void add(const RenderRequest& request, std::size_t place) {
    requests.push_back(request);
    places.push_back(place);
  }
  /// Whether the oracle's hits are the same for a request.
  bool has_hits_of(const RenderRequest& request) const {
    return requests.front().stage == request.stage && requests.front().values == request.values;
  }
};

}  // namespace

Result<std::vector<RenderResult>> render(Backend& backend, const Registry& registry, const Scene& scene,
                                         std::span<const Mesh> meshes, MapSet& maps,
                                         std::span<const RenderRequest> requests, std::vector<std::string>* messages) {
  RequestGroup drawn;
  std::vector<RequestGroup> replayed;
  for (std::size_t k = 0; k < requests.size(); ++k) {
    if (requests[k].technique != "oracle" || maps.contains("oracle_hits")) {
      drawn.add(requests[k], k);
      continue;
    }
    auto group = std::find_if(replayed.begin(), replayed.end(),
                              [&](const RequestGroup& known) { return known.has_hits_of(requests[k]); });
    if (group == replayed.end()) group = replayed.emplace(replayed.end());
    group->add(requests[k], k);
  }
  Renderer renderer(backend, registry, scene, messages);
  std::vector<RenderResult> rendered(meshes.size() * requests.size());
  const auto put = [&](const RequestGroup& group, std::size_t first_mesh, std::vector<RenderResult> results) {
    for (std::size_t i = 0; i < results.size(); ++i) {
      const std::size_t mesh = first_mesh + i / group.places.size();
      rendered[mesh * requests.size() + group.places[i % group.places.size()]] = std::move(results[i]);
    }
  };
  if (!drawn.requests.empty()) {
    Rendered results = renderer.draw(meshes, maps, drawn.requests);
    if (!results) return results;
    put(drawn, 0, *std::move(results));
  }
  for (const RequestGroup& group : replayed) {
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      Rendered results = renderer.replay(meshes[m], maps, group.requests);
      if (!results) return results;
      put(group, m, *std::move(results));
    }
  }
  return rendered;
}

Result<RenderResult> render(Backend& backend, const Registry& registry, const Scene& scene, const Mesh& mesh,
                            MapSet& maps, const RenderRequest& request, std::vector<std::string>* messages) {
  Rendered rendered = render(backend, registry, scene, {&mesh, 1}, maps, {&request, 1}, messages);
  if (!rendered) return tl::unexpected(rendered.error());
  return std::move(rendered->front());
}

}  // namespace relievo
