/// One scene three times: a technique of the SDK inside OGRE, OGRE's own parallax, and the SDK's own renderer.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "job_material.hpp"
#include "own_parallax.hpp"
#include "relievo/image.hpp"

namespace {

using relievo::Result;
using relievo::Status;

// The oldest text that gives each sampler its unit: GL3Plus validates programs before it sets theirs.
constexpr const char* language = "glsl-430";

struct Options {
  std::string scene, technique = "quadrant_maxima", folder;
};

/// What the SDK makes before OGRE starts.
struct Prepared {
  relievo::Scene scene;
  relievo::Mesh mesh;
  relievo::MapSet maps;
  relievo::Job job;  ///< for OGRE
  Picture reference;
};

/// Bakes what the technique reads, makes the Job for OGRE, and draws the same scene with the SDK's own renderer.
Status prepare(const relievo::Registry& registry, const relievo::RenderRequest& request, Prepared& made) {
  Result<std::unique_ptr<relievo::Backend>> backend = relievo::open_backend("opengl");
  if (!backend) return tl::unexpected(backend.error());
  Result<relievo::RenderResult> drawn =
      relievo::render(**backend, registry, made.scene, made.mesh, made.maps, request);  // bakes into made.maps
  if (!drawn) return tl::unexpected(drawn.error());
  made.reference = {drawn->image.width, drawn->image.height, std::move(drawn->color)};
  Result<relievo::Job> job = relievo::make_render_job(registry, made.scene, made.mesh, made.maps, request, language);
  if (!job) return tl::unexpected(job.error());
  made.job = std::move(*job);
  return {};
}

Status load(const Options& options, Prepared& made) {
  Result<relievo::Scene> scene = relievo::load_scene(options.scene);
  if (!scene) return tl::unexpected(scene.error());
  Result<relievo::Mesh> mesh = relievo::scene_mesh(*scene);
  if (!mesh) return tl::unexpected(mesh.error());
  Result<relievo::HeightMap> height_map = relievo::scene_height_map(*scene);
  if (!height_map) return tl::unexpected(height_map.error());
  made.scene = std::move(*scene);
  made.mesh = std::move(*mesh);
  made.maps = relievo::map_set(*height_map);
  return {};
}

Result<Picture> draw_technique(Engine& engine, const Prepared& made) {
  Ogre::SceneManager* scene = engine.add_scene("technique", made.scene.camera);
  if (Status status = add_job(*scene, made.job, language); !status) return tl::unexpected(status.error());
  SceneFeed feed(made.scene);
  scene->getCamera(camera_name)->addListener(&feed);
  Picture picture = engine.draw(scene, made.scene.image, false);  // the stage encodes its colours itself
  scene->getCamera(camera_name)->removeListener(&feed);
  return picture;
}

Picture draw_own_parallax(Engine& engine, const Prepared& made) {
  Ogre::SceneManager* scene = engine.add_scene("own parallax", made.scene.camera);
  add_own_parallax(*scene, made.scene, made.mesh, made.maps);
  return engine.draw(scene, made.scene.image, true);
}

Status write(const std::string& folder, const char* file, const Picture& picture) {
  return relievo::write_png(std::filesystem::path(folder) / file, picture.width, picture.height, 4, picture.pixels);
}

Picture side_by_side(const std::vector<const Picture*>& pictures) {
  Picture wide{0, pictures.front()->height, {}};
  for (const Picture* picture : pictures) wide.width += picture->width;
  for (int y = 0; y < wide.height; ++y) {
    for (const Picture* picture : pictures) {
      const std::size_t row = static_cast<std::size_t>(picture->width) * 4;
      const std::uint8_t* first = picture->pixels.data() + static_cast<std::size_t>(y) * row;
      wide.pixels.insert(wide.pixels.end(), first, first + row);
    }
  }
  for (std::size_t i = 3; i < wide.pixels.size(); i += 4) wide.pixels[i] = 255;
  return wide;
}

Status run(const Options& options) {
  Result<relievo::Registry> registry = relievo::load_registry();
  if (!registry) return tl::unexpected(registry.error());
  Prepared made;
  if (Status status = load(options, made); !status) return status;
  relievo::RenderRequest request;
  request.stage = "surface";
  request.technique = options.technique;
  if (Status status = prepare(*registry, request, made); !status) return status;

  Engine engine;
  Result<Picture> technique = draw_technique(engine, made);
  if (!technique) return tl::unexpected(technique.error());
  const Picture own = draw_own_parallax(engine, made);
  if (engine.complaints() > 0)
    return relievo::fail(relievo::ErrorCode::backend, "ogre.complaint", "OGRE reports errors or warnings; see above");
  std::filesystem::create_directories(options.folder);
  if (Status status = write(options.folder, "technique.png", *technique); !status) return status;
  if (Status status = write(options.folder, "own_parallax.png", own); !status) return status;
  return write(options.folder, "side_by_side.png", side_by_side({&*technique, &own, &made.reference}));
}

bool parse(int argc, char** argv, Options& options) {
  std::vector<std::string> rest;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--technique" && i + 1 < argc)
      options.technique = argv[++i];
    else
      rest.emplace_back(argv[i]);
  }
  if (rest.size() != 2) return false;
  options.scene = rest[0];
  options.folder = rest[1];
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!parse(argc, argv, options)) {
    std::fprintf(stderr, "usage: relievo_ogre SCENE.toml FOLDER [--technique NAME]\n");
    return 1;
  }
  try {
    const Status status = run(options);
    if (status) return 0;
    std::fprintf(stderr, "%s\n", relievo::format(status.error()).c_str());
    return relievo::exit_code(status.error().code);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "OGRE: %s\n", error.what());
    return 1;
  }
}
