/// The drawing stages as Jobs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "job/camera.hpp"
#include "job/mesh_buffers.hpp"
#include "job/oracle_picture.hpp"
#include "job/program.hpp"
#include "job/vectors.hpp"
#include "relievo/render.hpp"

namespace relievo {

namespace {

constexpr int scene_binding = 1;
constexpr std::size_t most_lights = 4;

/// The twin of the block `Scene` in shaders/lib/scene.glsl.
struct SceneBlock {
  glm::mat4 view_projection;
  glm::vec4 eye, displacement, albedo, specular;
  glm::ivec4 counts;
  std::array<glm::vec4, most_lights> light_direction, light_color;
};
static_assert(sizeof(SceneBlock) == 64 + 5 * 16 + 2 * 64);

SceneBlock make_scene_block(const Scene& scene) {
  SceneBlock block{};
  block.view_projection = view_projection(scene);
  block.eye = glm::vec4(to_vec3(scene.camera.position), 1);
  block.displacement = {scene.displacement.scale, scene.displacement.bias, 0, 0};
  block.albedo = glm::vec4(to_vec3(scene.material.albedo), scene.material.ambient);
  block.specular = {scene.material.specular, scene.material.shininess, 0, 0};
  std::size_t lights = scene.lights.size();
  block.counts = {static_cast<int>(lights), 0, 0, 0};
  for (std::size_t i = 0; i < lights; ++i) {
    block.light_direction[i] = glm::vec4(glm::normalize(to_vec3(scene.lights[i].direction)), 0);
    block.light_color[i] = glm::vec4(to_vec3(scene.lights[i].color), 0);
  }
  return block;
}

/// About one triangle a pixel of the image, with a ceiling on memory; what the `tessellation` loop says if it says so.
int tessellation_of(const ComposedProgram& composed, const Scene& scene, std::size_t triangles) {
  for (const ParameterSlot& slot : composed.parameters) {
    if (slot.name.ends_with(".tessellation") && slot.value > 0) return static_cast<int>(slot.value);
  }
  constexpr double a_pixel = 4, most = 2.0e6;
  double wanted = std::min(most, a_pixel * scene.image.width * scene.image.height);
  double factor = std::ceil(std::sqrt(wanted / static_cast<double>(std::max<std::size_t>(triangles, 1))));
  return static_cast<int>(std::clamp(factor, 1.0, 1024.0));
}

template <class T>
int add_buffer(Job& job, const char* name, const std::vector<T>& data) {
  job.buffers.push_back(make_buffer(name, data.data(), data.size() * sizeof(T)));
  return static_cast<int>(job.buffers.size()) - 1;
}

int add_target(Job& job, const char* name, Format format, const SceneImage& size) {
  Texture target;
  target.name = name;
  target.format = format;
  target.width = size.width;
  target.height = size.height;
  job.textures.push_back(std::move(target));
  return static_cast<int>(job.textures.size()) - 1;
}

Draw make_draw(const StageDescriptor& stage, const MeshBuffers& mesh, Job& job) {
  Draw draw;
  draw.vertex_buffer = add_buffer(job, "vertices", mesh.vertices);
  draw.index_buffer = add_buffer(job, "indices", mesh.indices);
  draw.vertex_stride = sizeof(MeshVertex);
  draw.attributes = mesh_attributes(stage.mesh == "prisms");
  draw.count = static_cast<std::uint32_t>(mesh.indices.size());
  draw.instances = stage.mesh == "prisms" ? 3 : 1;  // one instance a tetrahedron
  draw.clear_color = std::array<float, 4>{0, 0, 0, 0};
  draw.clear_depth = 1.0f;
  return draw;
}

Status check_map(const MapSet& maps, const std::string& map, const RenderRequest& request) {
  if (maps.contains(map)) return {};
  return fail(ErrorCode::usage, "render.missing-map",
              fmt::format("technique '{}' in stage '{}' reads the map '{}', which the set of maps lacks; expected it "
                          "baked (bake_map)",
                          request.technique, request.stage, map));
}

}  // namespace

Result<std::vector<std::byte>> scene_block(const Scene& scene) {
  if (scene.lights.size() > most_lights) {
    return fail(
        ErrorCode::usage, "render.lights",
        fmt::format("the scene has {} lights; the drawing stages take at most {}", scene.lights.size(), most_lights),
        scene.file);
  }
  SceneBlock block = make_scene_block(scene);
  const auto* bytes = reinterpret_cast<const std::byte*>(&block);
  return std::vector<std::byte>(bytes, bytes + sizeof(block));
}

Result<Job> make_render_job(const Registry& registry, const Scene& scene, std::span<const Mesh> meshes,
                            const MapSet& maps, const RenderRequest& request, std::string_view shader_target) {
  Result<const StageDescriptor*> stage = registry.stage(request.stage);
  if (!stage) return tl::unexpected(stage.error());
  if ((*stage)->mesh == "none") {
    return fail(ErrorCode::usage, "render.stage",
                "stage '" + request.stage + "' draws nothing; expected one that has a mesh, such as 'surface'");
  }
  if (Status status = check_map(maps, "height", request); !status) return tl::unexpected(status.error());
  Permutation permutation;
  permutation.stage = request.stage;
  permutation.filter = request.filter;
  permutation.address = maps.at("height").address;
  permutation.aov = request.aov;
  permutation.values = request.values;
  for (const std::string& role : (*stage)->roles) permutation.roles[role] = request.technique;
  Result<PreparedProgram> prepared = prepare(registry, std::move(permutation), shader_target);
  if (!prepared) return tl::unexpected(prepared.error());
  for (const MapSlot& slot : prepared->composed.maps) {
    if (Status status = check_map(maps, slot.map, request); !status) return tl::unexpected(status.error());
  }

  Job job;
  job.name = "render " + prepared->composed.key;
  std::vector<ResourceBinding> resources;
  if (Status status = bind_maps(prepared->composed, maps, job, resources); !status)
    return tl::unexpected(status.error());
  bind_parameters(prepared->composed, job, resources);
  Result<std::vector<std::byte>> block = scene_block(scene);
  if (!block) return tl::unexpected(block.error());
  bind_buffer(0, scene_binding, make_buffer("Scene", block->data(), block->size()), job, resources);
  keep_contract(prepared->program, resources);
  for (const Mesh& mesh : meshes) {
    int tessellation =
        (*stage)->mesh == "tessellated" ? tessellation_of(prepared->composed, scene, mesh.triangles.size()) : 1;
    Draw draw = make_draw(**stage, make_mesh_buffers(mesh, scene.displacement.units, tessellation), job);
    draw.resources = resources;
    int color =
        add_target(job, "color", request.aov == Aov::color ? Format::rgba8_unorm : Format::rgba32_float, scene.image);
    draw.color_targets = {color};
    draw.depth_target = add_target(job, "depth", Format::d32_float, scene.image);
    job.commands.emplace_back(std::move(draw));
    job.read_backs.push_back({ReadBack::Source::texture, color, 0});
  }
  job.programs.push_back(std::move(prepared->program));
  return job;
}

Result<Job> make_render_job(const Registry& registry, const Scene& scene, const Mesh& mesh, const MapSet& maps,
                            const RenderRequest& request, std::string_view shader_target) {
  return make_render_job(registry, scene, std::span<const Mesh>(&mesh, 1), maps, request, shader_target);
}

namespace {

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

RenderResult result_of(const Mesh& mesh, const std::vector<std::byte>& pixels, const SceneImage& size, Aov aov) {
  RenderResult rendered;
  rendered.image = to_image(pixels, size, aov);
  if (aov == Aov::color) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(pixels.data());
    rendered.color.assign(bytes, bytes + pixels.size());
  }
  for (const TriangleFrame& frame : triangle_frames(mesh)) rendered.degenerate_triangles += frame.degenerate;
  return rendered;
}

Result<std::vector<RenderResult>> render_meshes(Backend& backend, const Registry& registry, const Scene& scene,
                                                std::span<const Mesh> meshes, MapSet& maps,
                                                const RenderRequest& request, std::vector<std::string>* messages) {
  Result<std::vector<std::string>> needed = required_maps(registry, request.stage, request.technique);
  if (!needed) return tl::unexpected(needed.error());
  for (const std::string& map : *needed) {
    if (Status status = bake_map(backend, registry, map, maps, request.values, messages); !status)
      return tl::unexpected(status.error());
  }
  RenderRequest suited = request;
  suited.values = values_on(registry, backend.info(), std::move(suited.values));
  Result<Job> job = make_render_job(registry, scene, meshes, maps, suited, backend.info().shader_target);
  if (!job) return tl::unexpected(job.error());
  Result<JobResult> result = backend.execute(*job);
  if (!result) return tl::unexpected(result.error());
  append_messages(*result, messages);
  std::vector<RenderResult> rendered;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    rendered.push_back(result_of(meshes[k], result->read_backs.at(k), scene.image, request.aov));
    if (!result->command_seconds.empty()) rendered.back().seconds = result->command_seconds[k];
  }
  return rendered;
}

Result<RenderResult> only(Result<std::vector<RenderResult>> rendered) {
  if (!rendered) return tl::unexpected(rendered.error());
  return std::move(rendered->front());
}

Result<RenderResult> render_once(Backend& backend, const Registry& registry, const Scene& scene, const Mesh& mesh,
                                 MapSet& maps, const RenderRequest& request, std::vector<std::string>* messages) {
  return only(render_meshes(backend, registry, scene, {&mesh, 1}, maps, request, messages));
}

/// The rays of the pixels come from the stage itself, written as pictures.
Result<MapData> surface_hits(Backend& backend, const Registry& registry, const Scene& scene, const Mesh& mesh,
                             MapSet& maps, RenderRequest request, std::vector<std::string>* messages) {
  request.technique = "bump";
  request.aov = Aov::ray_origin;
  Result<RenderResult> origins = render_once(backend, registry, scene, mesh, maps, request, messages);
  if (!origins) return tl::unexpected(origins.error());
  request.aov = Aov::ray_direction;
  Result<RenderResult> directions = render_once(backend, registry, scene, mesh, maps, request, messages);
  if (!directions) return tl::unexpected(directions.error());
  return exact_surface_hits(height_map_of(maps), origins->image, directions->image);
}

/// Computes the exact hits of the pixels on the CPU, then lets the stage replay them (techniques/oracle).
Result<RenderResult> render_oracle(Backend& backend, const Registry& registry, const Scene& scene, const Mesh& mesh,
                                   MapSet& maps, const RenderRequest& request, std::vector<std::string>* messages) {
  Result<const StageDescriptor*> stage = registry.stage(request.stage);
  if (!stage) return tl::unexpected(stage.error());
  Result<MapData> hits = fail(ErrorCode::unsupported, "render.oracle-stage",
                              "the oracle has no picture of stage '" + request.stage + "', which draws the mesh '" +
                                  (*stage)->mesh + "'; expected 'base' or 'prisms'");
  if ((*stage)->mesh == "base") hits = surface_hits(backend, registry, scene, mesh, maps, request, messages);
  if ((*stage)->mesh == "prisms") hits = exact_prism_hits(height_map_of(maps), scene, mesh);
  if (!hits) return tl::unexpected(hits.error());
  MapSet with_hits;  // of the others, what the stage itself reads: maps may be large
  Result<std::vector<std::string>> needed = required_maps(registry, request.stage, request.technique);
  if (!needed) return tl::unexpected(needed.error());
  for (const std::string& map : *needed) {
    if (const auto known = maps.find(map); known != maps.end()) with_hits.insert(*known);
  }
  with_hits.insert(*maps.find("height"));
  with_hits["oracle_hits"] = std::move(*hits);
  return render_once(backend, registry, scene, mesh, with_hits, request, messages);
}

}  // namespace

Result<std::vector<RenderResult>> render(Backend& backend, const Registry& registry, const Scene& scene,
                                         std::span<const Mesh> meshes, MapSet& maps, const RenderRequest& request,
                                         std::vector<std::string>* messages) {
  const bool replay = request.technique == "oracle" && !maps.contains("oracle_hits");
  if (!replay) return render_meshes(backend, registry, scene, meshes, maps, request, messages);
  std::vector<RenderResult> rendered;
  for (const Mesh& mesh : meshes) {
    Result<RenderResult> one = render_oracle(backend, registry, scene, mesh, maps, request, messages);
    if (!one) return tl::unexpected(one.error());
    rendered.push_back(std::move(*one));
  }
  return rendered;
}

Result<RenderResult> render(Backend& backend, const Registry& registry, const Scene& scene, const Mesh& mesh,
                            MapSet& maps, const RenderRequest& request, std::vector<std::string>* messages) {
  return only(render(backend, registry, scene, std::span<const Mesh>(&mesh, 1), maps, request, messages));
}

}  // namespace relievo
