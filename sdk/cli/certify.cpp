/// relievo certify: does a baked map keep what it promises?
#include "relievo/certify.hpp"

#include <fmt/format.h>
#include <chrono>

#include "common.hpp"

namespace relievo::cli {

namespace {

struct CertifyCommand {
  std::string map, height, file, address, backend = "vulkan";
  std::vector<std::string> set;
  double tolerance = 0;
};

/// The map, and the parameters that it was baked with.
struct Candidate {
  MapData map;
  std::map<std::string, double> values;
};

bool has_description(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::exists(file + ".json", ignored);
}

/// What --set and --address say must be what the file's description says.
Status check_description(const CertifyCommand& command, const MapFile& file,
                         const std::map<std::string, double>& given) {
  if (file.map.name != command.map) {
    return fail(ErrorCode::usage, "certify.other-map",
                fmt::format("the file holds map '{}'; expected '{}'", file.map.name, command.map), command.file);
  }
  if (!command.address.empty() && command.address != to_string(file.map.address)) {
    return fail(ErrorCode::usage, "certify.address",
                fmt::format("--address is {}; the map was baked for {}", command.address, to_string(file.map.address)),
                command.file);
  }
  for (const auto& [name, value] : given) {
    const auto baked = file.values.find(name);
    if (baked == file.values.end() || baked->second == value) continue;
    return fail(ErrorCode::usage, "certify.parameter",
                fmt::format("--set {}={}: the map was baked with {}", name, value, baked->second), command.file);
  }
  return {};
}

/// A file with a description says itself what it is; else the parameters do.
Result<Candidate> read_candidate(const Registry& registry, const CertifyCommand& command, const MapDescriptor& map,
                                 const HeightMap& height, const std::map<std::string, double>& given) {
  if (has_description(command.file)) {
    Result<MapFile> file = read_map(command.file);
    if (!file) return tl::unexpected(file.error());
    if (Status status = check_description(command, *file, given); !status) return tl::unexpected(status.error());
    file->values.insert(given.begin(), given.end());
    return Candidate{std::move(file->map), std::move(file->values)};
  }
  // Composing checks the values, of which the shape depends.
  Result<ComposedProgram> composed = compose_bake(registry, command.map, height.address, given);
  if (!composed) return tl::unexpected(composed.error());
  const MapData shape = map_shape(map, height.width, height.height, height.address, given);
  Result<MapFile> file = read_map(command.file, &shape);
  if (!file) return tl::unexpected(file.error());
  return Candidate{std::move(file->map), given};
}

Result<Candidate> bake_candidate(const Registry& registry, const CertifyCommand& command, const HeightMap& height,
                                 const std::map<std::string, double>& given) {
  Result<std::unique_ptr<Backend>> backend = open(command.backend, false);
  if (!backend) return tl::unexpected(backend.error());
  MapSet maps = map_set(height);
  if (Status status = bake_map(**backend, registry, command.map, maps, given); !status)
    return tl::unexpected(status.error());
  return Candidate{std::move(maps.at(command.map)), given};
}

void print(const Context& context, const Certificate& c, double seconds) {
  if (context.json) {
    nlohmann::json json = {{"map", c.map},         {"promise", c.promise},       {"guaranteed", c.guaranteed},
                           {"checked", c.checked}, {"violations", c.violations}, {"worst", c.worst},
                           {"seconds", seconds}};
    if (c.violations > 0) json["texel"] = {{"x", c.x}, {"y", c.y}, {"level", c.level}, {"layer", c.layer}};
    print_json(json);
    return;
  }
  fmt::print("{}: {}{}\n{} checked, {} violations", c.map, c.promise, c.guaranteed ? "" : " (not guaranteed)",
             c.checked, c.violations);
  if (c.violations > 0)
    fmt::print(", worst {:.6g} at texel ({}, {}) of level {}, layer {}", c.worst, c.x, c.y, c.level, c.layer);
  fmt::print(", {:.3f} s\n", seconds);
}

Status run_certify(const Context& context, const CertifyCommand& command) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  Result<const MapDescriptor*> map = registry->map(command.map);
  if (!map) return tl::unexpected(map.error());
  Result<Settings> settings = parse_settings(*registry, command.set, command.map);
  if (!settings) return tl::unexpected(settings.error());
  Result<HeightMap> height = load_height(command.height, command.address.empty() ? "repeat" : command.address);
  if (!height) return tl::unexpected(height.error());
  Result<Candidate> candidate = command.file.empty()
                                    ? bake_candidate(*registry, command, *height, settings->values)
                                    : read_candidate(*registry, command, **map, *height, settings->values);
  if (!candidate) return tl::unexpected(candidate.error());
  height->address = candidate->map.address;
  CertifyOptions options;
  options.values = std::move(candidate->values);
  options.tolerance = command.tolerance;
  const auto start = std::chrono::steady_clock::now();
  Result<Certificate> certificate = certify(*height, candidate->map, options);
  if (!certificate) return tl::unexpected(certificate.error());
  print(context, *certificate, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (certificate->violations == 0 || !certificate->guaranteed) return {};
  return fail(ErrorCode::mismatch, "certify.violations",
              fmt::format("map '{}' breaks its promise at {} of {} places; expected none", command.map,
                          certificate->violations, certificate->checked),
              command.file);
}

}  // namespace

void add_certify(CLI::App& app, Context& context) {
  auto command = std::make_shared<CertifyCommand>();
  CLI::App* sub = add_command(app, context, "certify", "Check a baked map against the exact surface",
                              [&context, command] { return run_certify(context, *command); });
  sub->add_option("name", command->map, "Map to certify")->required();
  sub->add_option("--height", command->height, "Height file that it was baked from")->required();
  sub->add_option("--map", command->file, "What `relievo bake -o` wrote; without it the map is baked now");
  sub->add_option("--address", command->address, "repeat, mirror, clamp or clip; by default the file's, else repeat");
  sub->add_option("--backend", command->backend, "Bakes when no --map is given")->capture_default_str();
  sub->add_option("--set", command->set, "map.parameter=value: what it was baked with");
  sub->add_option("--tolerance", command->tolerance, "A promise broken by no more than this is kept")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

}  // namespace relievo::cli
