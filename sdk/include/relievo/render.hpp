/// Pictures of a scene: a mesh, a technique and a drawing stage as a Job.
/// Every function here is thread-safe; `render` changes its maps and messages, with a backend that no other thread uses
/// meanwhile.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "relievo/backend.hpp"
#include "relievo/compile.hpp"
#include "relievo/image.hpp"
#include "relievo/maps.hpp"
#include "relievo/scene.hpp"
#include "relievo/trace.hpp"

namespace relievo {

struct RenderRequest {
  std::string stage;
  std::string technique;  ///< bound to every role of the stage; empty for stages that trace nothing
  HeightFilter filter = HeightFilter::hardware;
  Aov aov = Aov::color;
  std::map<std::string, double> values;  ///< "owner.parameter"; those of other owners are ignored
};

struct RenderResult {
  Image image;                      ///< 4 channels; alpha 1 where something was drawn. colour: [0,1]; others: see Aov
  std::vector<std::uint8_t> color;  ///< aov color only: the 8-bit pixels as the backend wrote them
  double seconds = -1;              ///< of the draw, by the GPU's clock; −1 without timestamps
  std::uint64_t degenerate_triangles = 0;  ///< drawn undisplaced
};

/// The bytes of the uniform block `Scene` (set 0, binding 1, std140) that every drawing stage reads: camera,
/// displacement, material and lights. An engine writes them anew when its camera or lights have moved; the rest of the
/// Job stays. Errors: "render.lights" for more than four.
Result<std::vector<std::byte>> scene_block(const Scene& scene);

/// One Draw of the scene's mesh. `mesh` is checked and has one normal a position (scene_mesh does both); `maps` holds
/// the maps that the permutation reads (all of required_maps will do), else the error is "render.missing-map".
Result<Job> make_render_job(const Registry& registry, const Scene& scene, const Mesh& mesh, const MapSet& maps,
                            const RenderRequest& request, std::string_view shader_target);

/// The same for several meshes in place of the scene's, and several requests, each in a picture of its own: command and
/// read-back m · requests + k are those of mesh m with request k. They share maps, and programs where they can.
Result<Job> make_render_job(const Registry& registry, const Scene& scene, std::span<const Mesh> meshes,
                            const MapSet& maps, std::span<const RenderRequest> requests,
                            std::string_view shader_target);

/// Bakes what is missing in `maps`, makes the job and runs it. With several meshes and requests: a result for each, in
/// the same order, of one Job (but the oracle's pictures, whose hits are those of a mesh in a stage, of one for each of
/// these). Maps that are all there are only read: several threads may draw with them.
Result<RenderResult> render(Backend& backend, const Registry& registry, const Scene& scene, const Mesh& mesh,
                            MapSet& maps, const RenderRequest& request, std::vector<std::string>* messages = nullptr);

Result<std::vector<RenderResult>> render(Backend& backend, const Registry& registry, const Scene& scene,
                                         std::span<const Mesh> meshes, MapSet& maps,
                                         std::span<const RenderRequest> requests,
                                         std::vector<std::string>* messages = nullptr);

}  // namespace relievo
