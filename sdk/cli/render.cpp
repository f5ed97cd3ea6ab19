/// relievo render: a picture of a scene.
#include <fmt/format.h>

#include "aov_picture.hpp"
#include "common.hpp"
#include "relievo/image.hpp"

namespace relievo::cli {

namespace {

struct RenderOptions {
  std::string scene, technique, stage = "surface", backend = "vulkan", output, aov = "color", filter = "hardware";
  std::vector<std::string> set;
  int width = 0, height = 0;
  bool validation = false;
};

Status write_image(const RenderResult& result, Aov aov, const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".exr") return write_exr(path, result.image);
  if (extension != ".png")
    return fail(ErrorCode::usage, "render.format",
                fmt::format("'{}' has the extension '{}'; expected .png or .exr", path, extension), path);
  if (aov == Aov::color) return write_png(path, result.image.width, result.image.height, 4, result.color);
  return write_png(path, aov_picture(result.image, aov));
}

Status run_render(const Context& context, const RenderOptions& options) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  Result<Settings> settings = parse_settings(*registry, options.set, options.technique);
  if (!settings) return tl::unexpected(settings.error());
  Result<Aov> aov = parse_aov(options.aov);
  if (!aov) return tl::unexpected(aov.error());
  Result<HeightFilter> filter = parse_height_filter(options.filter);
  if (!filter) return tl::unexpected(filter.error());
  Result<LoadedScene> loaded = load_scene_parts(options.scene);
  if (!loaded) return tl::unexpected(loaded.error());
  if (options.width > 0) loaded->scene.image.width = options.width;
  if (options.height > 0) loaded->scene.image.height = options.height;
  Result<std::unique_ptr<Backend>> backend = open(options.backend, options.validation);
  if (!backend) return tl::unexpected(backend.error());
  RenderRequest request{options.stage, options.technique, *filter, *aov, settings->values};
  if (auto own = settings->filters.find(options.technique); own != settings->filters.end())
    request.filter = own->second;
  MapSet maps = map_set(loaded->height);
  std::vector<std::string> messages;
  Result<RenderResult> result = render(**backend, *registry, loaded->scene, loaded->mesh, maps, request, &messages);
  for (const std::string& message : messages) fmt::print(stderr, "{}\n", message);
  if (!result) return tl::unexpected(result.error());
  if (Status status = write_image(*result, *aov, options.output); !status) return status;
  if (context.json) {
    print_json({{"output", options.output},
                {"width", result->image.width},
                {"height", result->image.height},
                {"seconds", result->seconds < 0 ? nlohmann::json() : nlohmann::json(result->seconds)},
                {"degenerate_triangles", result->degenerate_triangles}});
  } else {
    const std::string time = result->seconds < 0 ? "not timed" : fmt::format("{:.1f} ms", result->seconds * 1e3);
    fmt::print("{}x{}, {} -> {}\n", result->image.width, result->image.height, time, options.output);
    if (result->degenerate_triangles)
      fmt::print("{} degenerate triangles drawn undisplaced\n", result->degenerate_triangles);
  }
  return {};
}

}  // namespace

void add_render(CLI::App& app, Context& context) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = add_command(app, context, "render", "Render a scene",
                                  [&context, options] { return run_render(context, *options); });
  command->add_option("scene", options->scene, "Scene file (TOML)")->required();
  command->add_option("--technique", options->technique, "Technique for the stage's roles");
  command->add_option("--stage", options->stage, "surface, vertex, prism, …")->capture_default_str();
  command->add_option("--backend", options->backend, "vulkan, opengl, vulkan_loose, …")->capture_default_str();
  command->add_option("-o,--output", options->output, ".png, or .exr for the numbers")->required();
  command->add_option("--aov", options->aov, "color, depth, normal, uv, steps, status, ray_origin or ray_direction")
      ->capture_default_str();
  command->add_option("--filter", options->filter, "hardware or exact")->capture_default_str();
  command->add_option("--set", options->set, "parameter=value");
  command->add_option("--width", options->width, "Instead of the scene's")->check(CLI::Range(1, 8192));
  command->add_option("--height", options->height, "Instead of the scene's")->check(CLI::Range(1, 8192));
  command->add_flag("--validation", options->validation, "Validation layer or debug output on stderr");
}

}  // namespace relievo::cli
