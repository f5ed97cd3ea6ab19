/// relievo bake: a map from a height file.
#include <fmt/format.h>
#include <algorithm>
#include <chrono>

#include "common.hpp"
#include "relievo/image.hpp"

namespace relievo::cli {

namespace {

struct BakeOptions {
  std::string map, height, address = "repeat", backend = "vulkan", output;
  std::vector<std::string> set;
};

/// PNG shows signed channels, as normal maps do: [-1,1] becomes [0,1].
Image to_image(const MapData& map, bool for_png) {
  Image image{map.width, map.height, map.channels, map.texels};
  image.pixels.resize(map_level(map, 1).offset * static_cast<std::size_t>(map.channels));  // level 0
  bool is_signed = std::any_of(map.texels.begin(), map.texels.end(), [](float t) { return t < 0; });
  if (for_png && is_signed) {
    for (float& value : image.pixels) value = 0.5f + 0.5f * value;
  }
  return image;
}

Status write_map(const MapData& map, const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".png") return write_png(path, to_image(map, true));
  if (extension == ".pfm") return write_pfm(path, to_image(map, false));
  if (extension == ".exr") return write_exr(path, to_image(map, false));
  return fail(ErrorCode::usage, "bake.format",
              fmt::format("'{}' has the extension '{}'; expected .exr, .pfm or .png", path, extension), path);
}

Status run_bake(const Context& context, const BakeOptions& options) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  Result<const MapDescriptor*> descriptor = registry->map(options.map);
  if (!descriptor) return tl::unexpected(descriptor.error());
  if ((*descriptor)->module.empty()) {
    return fail(ErrorCode::usage, "bake.provided-map",
                fmt::format("map '{}' is given by the caller; expected a map that is baked", options.map));
  }
  Result<Settings> settings = parse_settings(*registry, options.set, options.map);
  if (!settings) return tl::unexpected(settings.error());
  Result<HeightMap> height = load_height(options.height, options.address);
  if (!height) return tl::unexpected(height.error());
  Result<std::unique_ptr<Backend>> backend = open(options.backend, false);
  if (!backend) return tl::unexpected(backend.error());
  MapSet maps = map_set(*height);
  auto start = std::chrono::steady_clock::now();
  if (Status status = bake_map(**backend, *registry, options.map, maps, settings->values); !status) return status;
  double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const MapData& map = maps.at(options.map);
  if (Status status = write_map(map, options.output); !status) return status;
  std::size_t bytes = map.texels.size() * sizeof(float);
  if (context.json) {
    fmt::print("{}\n", nlohmann::json{{"map", map.name},
                                      {"width", map.width},
                                      {"height", map.height},
                                      {"channels", map.channels},
                                      {"bytes", bytes},
                                      {"seconds", seconds},
                                      {"output", options.output}}
                           .dump(2));
  } else {
    fmt::print("{}: {}x{}x{}, {} bytes, {:.3f} s -> {}\n", map.name, map.width, map.height, map.channels, bytes,
               seconds, options.output);
  }
  return {};
}

}  // namespace

void add_bake(CLI::App& app, Context& context) {
  auto options = std::make_shared<BakeOptions>();
  CLI::App* command = add_command(app, context, "bake", "Bake a map from a height map",
                                  [&context, options] { return run_bake(context, *options); });
  command->add_option("map", options->map, "Map to bake")->required();
  command->add_option("--height", options->height, "Height file")->required();
  command->add_option("-o,--output", options->output, ".exr or .pfm (lossless), .png")->required();
  command->add_option("--address", options->address, "repeat, mirror, clamp or clip")->capture_default_str();
  command->add_option("--backend", options->backend)->capture_default_str();
  command->add_option("--set", options->set, "map.parameter=value");
}

}  // namespace relievo::cli
