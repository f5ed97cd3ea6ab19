/// The drawing stages as Jobs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <map>

#include "describe/origins.hpp"
#include "job/camera.hpp"
#include "job/mesh_buffers.hpp"
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

/// What a request brings to each of its draws.
struct DrawPlan {
  const RenderRequest* request = nullptr;
  const StageDescriptor* stage = nullptr;
  ComposedProgram composed;
  int program = 0;
  std::vector<ResourceBinding> resources;
};

/// A mesh's buffers in a job: requests that want it tessellated alike share them.
class JobMesh {
 public:
  struct Indices {
    int vertex_buffer = 0, index_buffer = 0;
    std::uint32_t count = 0;  ///< of indices
  };

  JobMesh(const Mesh& mesh, const Scene& scene, Job& job) : mesh_(mesh), scene_(scene), job_(job) {}

  Indices tessellated(const DrawPlan& plan) {
    const int factor =
        plan.stage->mesh == "tessellated" ? tessellation_of(plan.composed, scene_, mesh_.triangles.size()) : 1;
    auto [known, is_new] = made_.try_emplace(factor);
    if (!is_new) return known->second;
    const MeshBuffers buffers = make_mesh_buffers(mesh_, scene_.displacement.units, factor);
    known->second = {add_buffer(job_, "vertices", buffers.vertices), add_buffer(job_, "indices", buffers.indices),
                     static_cast<std::uint32_t>(buffers.indices.size())};
    return known->second;
  }

 private:
  const Mesh& mesh_;
  const Scene& scene_;
  Job& job_;
  std::map<int, Indices> made_;  ///< by the factor of tessellation
};

void add_draw(const DrawPlan& plan, const JobMesh::Indices& mesh, int depth, const SceneImage& size, Job& job) {
  const bool is_color = plan.request->aov == Aov::color;
  Draw draw;
  draw.program = plan.program;
  draw.resources = plan.resources;
  draw.vertex_buffer = mesh.vertex_buffer;
  draw.index_buffer = mesh.index_buffer;
  draw.vertex_stride = sizeof(MeshVertex);
  draw.attributes = mesh_attributes(plan.stage->mesh == "prisms");
  draw.count = mesh.count;
  draw.instances = plan.stage->mesh == "prisms" ? 3 : 1;  // one instance a tetrahedron
  draw.clear_color = std::array<float, 4>{0, 0, 0, 0};
  draw.clear_depth = 1.0f;
  draw.color_targets = {add_target(job, "color", is_color ? Format::rgba8_unorm : Format::rgba32_float, size)};
  draw.depth_target = depth;
  job.read_backs.push_back({ReadBack::Source::texture, draw.color_targets.front(), 0});
  job.commands.emplace_back(std::move(draw));
}

Status check_map(const MapSet& maps, const std::string& map, const RenderRequest& request) {
  if (maps.contains(map)) return {};
  return fail(ErrorCode::usage, "render.missing-map",
              fmt::format("technique '{}' in stage '{}' reads the map '{}', which the set of maps lacks; expected it "
                          "baked (bake_map)",
                          request.technique, request.stage, map));
}

Result<DrawPlan> plan_draw(const Registry& registry, const MapSet& maps, const RenderRequest& request) {
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
  Result<ComposedProgram> composed = compose_known(registry, std::move(permutation));
  if (!composed) return tl::unexpected(name_file_on_disk(composed.error(), registry));
  for (const MapSlot& slot : composed->maps) {
    if (Status status = check_map(maps, slot.map, request); !status) return tl::unexpected(status.error());
  }
  return DrawPlan{&request, *stage, *std::move(composed), 0, {}};
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
                            const MapSet& maps, std::span<const RenderRequest> requests,
                            std::string_view shader_target) {
  Job job;
  job.name = "render";
  std::vector<DrawPlan> plans;
  SharedPrograms programs;
  Result<std::vector<std::byte>> block = scene_block(scene);
  if (!block) return tl::unexpected(block.error());
  std::vector<ResourceBinding> shared;
  bind_buffer(0, scene_binding, make_buffer("Scene", block->data(), block->size()), job, shared);
  for (const RenderRequest& request : requests) {
    Result<DrawPlan> plan = plan_draw(registry, maps, request);
    if (!plan) return tl::unexpected(plan.error());
    Result<int> program = programs.index_of(plan->composed, shader_target, job);
    if (!program) return tl::unexpected(name_file_on_disk(program.error(), registry));
    plan->program = *program;
    plan->resources = shared;
    if (Status status = bind_maps(plan->composed, maps, job, plan->resources); !status)
      return tl::unexpected(status.error());
    bind_parameters(plan->composed, job, plan->resources);
    keep_contract(job.programs[static_cast<std::size_t>(plan->program)], plan->resources);
    plans.push_back(*std::move(plan));
  }
  if (plans.empty() || meshes.empty()) return job;
  job.name += " " + plans.front().composed.key;
  if (plans.size() > 1) job.name += fmt::format(" and {} more", plans.size() - 1);
  const int depth = add_target(job, "depth", Format::d32_float, scene.image);  // which every draw clears
  for (const Mesh& mesh : meshes) {
    JobMesh buffers(mesh, scene, job);
    for (const DrawPlan& plan : plans) add_draw(plan, buffers.tessellated(plan), depth, scene.image, job);
  }
  keep_filters(job);
  return job;
}

Result<Job> make_render_job(const Registry& registry, const Scene& scene, const Mesh& mesh, const MapSet& maps,
                            const RenderRequest& request, std::string_view shader_target) {
  return make_render_job(registry, scene, {&mesh, 1}, maps, {&request, 1}, shader_target);
}

}  // namespace relievo
