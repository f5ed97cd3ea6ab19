/// relievo bake: a map from a height file.
#include <fmt/format.h>
#include <algorithm>
#include <chrono>

#include "bake_memory.hpp"
#include "common.hpp"
#include "relievo/image.hpp"

namespace relievo::cli {

namespace {

struct BakeOptions {
  std::string map, height, address = "repeat", backend = "vulkan", output;
  std::vector<std::string> set;
};

/// Level 0 or the first layer as a picture; signed channels become [0,1], as normal maps are shown.
Status write_picture(const MapData& map, const std::string& path) {
  Image image{map.width, map.height, map.channels, map.texels.floats()};
  const bool is_signed = std::any_of(image.pixels.begin(), image.pixels.end(), [](float t) { return t < 0; });
  image.pixels.resize(map_level(map, 1).offset * static_cast<std::size_t>(map.channels));
  if (is_signed) {
    for (float& value : image.pixels) value = 0.5f + 0.5f * value;
  }
  return write_png(path, image);
}

/// What the map was baked with: its own parameters in full, so that a later default does not change the file's meaning.
std::map<std::string, double> values_of(const MapDescriptor& map, const std::map<std::string, double>& given) {
  std::map<std::string, double> values = given;
  for (const Parameter& p : map.parameters) values.try_emplace(map.name + "." + p.name, p.value);
  return values;
}

struct Cost {
  double seconds = 0;
  double command_seconds = 0;     ///< of them, those on the device
  std::size_t device_bytes = 0;   ///< of the largest Job
  std::size_t process_bytes = 0;  ///< by which the process's peak rose; 0 where that is not known
};

nlohmann::json json_of(const MapData& map, const Cost& cost, const std::string& output, bool is_picture) {
  return {{"map", map.name},
          {"width", map.width},
          {"height", map.height},
          {"layers", map.depth},
          {"levels", map.levels},
          {"channels", map.channels},
          {"bits", map.bits},
          {"bytes", texture_bytes(map)},
          {"seconds", cost.seconds},
          {"command_seconds", cost.command_seconds},
          {"peak_device_bytes", cost.device_bytes},
          {"peak_process_bytes", cost.process_bytes},
          {"output", output},
          {"lossless", !is_picture}};
}

Result<Cost> bake(Backend& backend, const Registry& registry, const std::string& map, MapSet& maps,
                  const std::map<std::string, double>& values) {
  MeteredBackend metered(backend);
  const std::size_t before = process_peak_bytes();
  const auto start = std::chrono::steady_clock::now();
  if (Status status = bake_map(metered, registry, map, maps, values); !status) return tl::unexpected(status.error());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return Cost{seconds, metered.command_seconds(), metered.peak_bytes(), process_peak_bytes() - before};
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
  return_freed_memory();
  MapSet maps = map_set(*std::move(height));
  const Result<Cost> cost = bake(**backend, *registry, options.map, maps, settings->values);
  if (!cost) return tl::unexpected(cost.error());
  const MapData& map = maps.at(options.map);
  const bool is_picture = map.bits == 32 && std::filesystem::path(options.output).extension() == ".png";
  Status written = is_picture ? write_picture(map, options.output)
                              : write_map(options.output, map, values_of(**descriptor, settings->values));
  if (!written) return written;
  if (context.json) {
    print_json(json_of(map, *cost, options.output, is_picture));
  } else {
    fmt::print("{}: {}x{}x{}, {} levels, {} channels, {} bytes, {:.3f} s -> {}{}\n", map.name, map.width, map.height,
               map.depth, map.levels, map.channels, texture_bytes(map), cost->seconds, options.output,
               is_picture ? " (a picture: 8 bits, one level)" : "");
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
  command
      ->add_option("-o,--output", options->output,
                   ".exr or .pfm (all levels and layers, lossless); .png (the same for 8 and 16 bits, else a picture)")
      ->required();
  command->add_option("--address", options->address, "repeat, mirror, clamp or clip")->capture_default_str();
  command->add_option("--backend", options->backend, "vulkan, opengl, vulkan_loose, …")->capture_default_str();
  command->add_option("--set", options->set, "map.parameter=value");
}

}  // namespace relievo::cli
