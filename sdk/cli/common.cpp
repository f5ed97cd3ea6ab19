#include "common.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "files/whole_file.hpp"
#include "mesh_file.hpp"
#include "relievo/program_cache.hpp"

namespace relievo::cli {

Result<Registry> Context::registry() const {
  return load_registry(std::vector<std::filesystem::path>(folders.begin(), folders.end()));
}

void Context::report(const Error& error) {
  exit_code = relievo::exit_code(error.code);
  // What comes with its own JSON is said beside it.
  if (!json || error.code == ErrorCode::mismatch || error.id == "permute.failed") {
    fmt::print(stderr, "{}\n", format(error));
    return;
  }
  nlohmann::json object = {{"id", error.id}, {"message", error.message}, {"exit_code", exit_code}};
  if (!error.file.empty()) object["file"] = error.file;
  if (error.line > 0) object["line"] = error.line;
  if (error.column > 0) object["column"] = error.column;
  print_json({{"error", object}});
}

CLI::App* add_command(CLI::App& app, Context& context, const std::string& name, const std::string& title,
                      std::function<Status()> run) {
  CLI::App* command = app.add_subcommand(name, title);
  command
      ->add_option("--techniques-dir,--techniques-folder,-I", context.folders,
                   "Folder of technique, map or stage folders to add")
      ->type_name("DIR")
      ->allow_extra_args(false);
  command->add_flag("--json", context.json, "Machine-readable output");
  command->callback([&context, run = std::move(run)] {
    if (Status status = run(); !status) context.report(status.error());
  });
  return command;
}

void add_techniques_option(CLI::App& app, Context& context) {
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    if (command->get_option_no_throw("--techniques")) continue;
    command->add_option("--techniques", context.folders, "As --techniques-dir")
        ->type_name("DIR")
        ->allow_extra_args(false);
  }
}

KnownParameters known_parameters(const Registry& registry) {
  KnownParameters known;
  auto add = [&](const auto& descriptors) {
    for (const auto& [name, descriptor] : descriptors) {
      for (const Parameter& parameter : descriptor.parameters) known.emplace(name + "." + parameter.name, &parameter);
    }
  };
  add(registry.techniques);
  add(registry.maps);
  add(registry.stages);
  return known;
}

namespace {

/// A number, or the name of an axis's value.
Result<double> parse_setting(const Parameter& parameter, const std::string& key, const std::string& text) {
  if (!parameter.choices.empty()) {
    const Result<double> value = parse_value(parameter, text);
    if (value) return value;
    return fail(ErrorCode::usage, "cli.set", fmt::format("--set {}={}: {}", key, text, value.error().message));
  }
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) {
    return fail(ErrorCode::usage, "cli.set", fmt::format("--set {}={}: the value is not a number", key, text));
  }
  return value;
}

}  // namespace

std::string qualified(const std::string& key, const std::string& only) {
  return key.find('.') == std::string::npos && !only.empty() ? only + "." + key : key;
}

Result<const Parameter*> find_parameter(const KnownParameters& known, const std::string& key, const std::string& text) {
  if (const auto parameter = known.find(key); parameter != known.end()) return parameter->second;
  std::vector<std::string> names;
  for (const auto& [name, ignored] : known) names.push_back(name);
  const std::string nearest = nearest_name(key, names);
  return fail(ErrorCode::usage, "cli.set",
              fmt::format("{}: '{}' is no parameter{}", text, key,
                          nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

Result<Settings> parse_settings(const Registry& registry, const std::vector<std::string>& given,
                                const std::string& only) {
  Settings settings;
  const KnownParameters known = known_parameters(registry);
  for (const std::string& item : given) {
    std::size_t equals = item.find('=');
    if (equals == std::string::npos)
      return fail(ErrorCode::usage, "cli.set", fmt::format("--set {}: expected name=value", item));
    const std::string key = qualified(item.substr(0, equals), only), text = item.substr(equals + 1);
    std::string owner = key.substr(0, key.find('.'));
    if (key == owner + ".filter" && registry.techniques.contains(owner)) {
      Result<HeightFilter> filter = parse_height_filter(text);
      if (!filter) return tl::unexpected(filter.error());
      settings.filters[owner] = *filter;
      continue;
    }
    const Result<const Parameter*> parameter = find_parameter(known, key, "--set " + item);
    if (!parameter) return tl::unexpected(parameter.error());
    Result<double> value = parse_setting(**parameter, key, text);
    if (!value) return tl::unexpected(value.error());
    settings.values[key] = *value;
  }
  return settings;
}

ValueTexts to_texts(const Registry& registry, const std::map<std::string, double>& values) {
  const KnownParameters known = known_parameters(registry);
  ValueTexts texts;
  for (const auto& [name, value] : values) texts[name] = value_text(*known.at(name), value);
  return texts;
}

ValueTexts own_values(const Registry& registry, const BackendInfo& backend) {
  return to_texts(registry, values_on(registry, backend, {}));
}

std::string to_text(const ValueTexts& values) {
  std::vector<std::string> texts;
  for (const auto& [name, value] : values) texts.push_back(fmt::format("{}={}", name, value));
  return fmt::format("{}", fmt::join(texts, ", "));
}

namespace {

/// A cache that cannot be is done without: everything is compiled, as it is the first time.
void keep_programs() {
  static const bool kept = [] {
    if (default_cache_folder().empty()) return false;
    Result<std::unique_ptr<Cache>> cache = open_cache({});
    if (cache) use_program_cache(*std::move(cache));
    return cache.has_value();
  }();
  static_cast<void>(kept);
}

}  // namespace

Result<std::unique_ptr<Backend>> open(const std::string& name, bool validation) {
  keep_programs();
  BackendOptions options;
  options.validation = validation;
  return open_backend(name, options);
}

Result<std::vector<std::string>> technique_names(const Registry& registry, const std::vector<std::string>& given) {
  std::vector<std::string> names;
  for (const std::string& item : given) {
    std::stringstream stream(item);
    for (std::string name; std::getline(stream, name, ',');) {
      if (name == "all" || name == "always") {
        for (const auto& [known, descriptor] : registry.techniques) {
          const bool is_meant = name == "all" || descriptor.first_hit == FirstHit::always;
          if (is_meant && descriptor.technique_class != TechniqueClass::reference) names.push_back(known);
        }
        continue;
      }
      Result<const TechniqueDescriptor*> technique = registry.technique(name);
      if (!technique) return tl::unexpected(technique.error());
      names.push_back(name);
    }
  }
  if (names.empty())
    return fail(ErrorCode::usage, "cli.no-technique",
                "no technique is named; expected one or more, 'all', or 'always'");
  return names;
}

Result<HeightMap> load_height(const std::string& path, const std::string& address) {
  Result<AddressMode> mode = parse_address_mode(address);
  if (!mode) return tl::unexpected(mode.error());
  Result<HeightMap> map = load_height_map(path);
  if (map) map->address = *mode;
  return map;
}

void set_scale(const Registry& registry, double scale, const HeightMap& map, std::map<std::string, double>& values) {
  const double longer_sides = scale * map.width / std::max(map.width, map.height);
  const auto set = [&](const std::string& owner, const std::vector<Parameter>& parameters) {
    for (const Parameter& p : parameters) {
      if (p.name != "scale") continue;
      const double value = p.unit == "longer sides of the map" ? longer_sides : scale;
      values.try_emplace(owner + ".scale", std::clamp(value, p.minimum, p.maximum));
    }
  };
  set("ray", registry.stages.at("ray").parameters);
  for (const auto& [name, descriptor] : registry.maps) set(name, descriptor.parameters);
}

Result<LoadedScene> load_scene_parts(const std::filesystem::path& path) {
  Result<Scene> scene = load_scene(path);
  if (!scene) return tl::unexpected(scene.error());
  Result<Mesh> mesh = scene_mesh(*scene, load_mesh_file);
  if (!mesh) return tl::unexpected(mesh.error());
  Result<HeightMap> height = scene_height_map(*scene);
  if (!height) return tl::unexpected(height.error());
  return LoadedScene{std::move(*scene), std::move(*mesh), std::move(*height)};
}

void print_json(const nlohmann::json& document) {
  fmt::print("{}\n", document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string json_text(const nlohmann::json& document) {
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Status write_text(const std::string& path, const std::string& text) {
  if (path == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);  // main looks whether it came out
    return {};
  }
  return write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "cli");
}

Status make_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    return fail(ErrorCode::io, "cli.folder",
                fmt::format("folder '{}' cannot be made: {}", path.string(), error.message()), path.string());
  return {};
}

double median(std::vector<double> values) {
  if (values.empty()) return -1;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.size() % 2 == 1 ? *middle : (*middle + *std::max_element(values.begin(), middle)) / 2;
}

std::string percent_text(double percent) {
  if (std::isnan(percent)) return "–";
  if (percent == 0) return "0";
  return percent < 0.0005 ? "<0.001" : fmt::format("{:.3f}", percent);
}

std::string error_text(double error) {
  return std::isnan(error) ? "–" : fmt::format("{:.2e}", error);
}

nlohmann::json to_json(const ErrorFigures& f) {
  auto quantiles = [](const ErrorQuantiles& q) {
    return nlohmann::json{{"p50", q.p50}, {"p99", q.p99}, {"max", q.max}};
  };
  return {{"rays", f.rays},
          {"ambiguous", f.ambiguous},
          {"judged", f.judged},
          {"missed", f.missed},
          {"false_hit", f.false_hit},
          {"wrong_layer", f.wrong_layer},
          {"exhausted", f.exhausted},
          {"missed_percent", f.percent(f.missed)},
          {"false_hit_percent", f.percent(f.false_hit)},
          {"wrong_layer_percent", f.percent(f.wrong_layer)},
          {"wrong_percent", f.wrong_percent()},
          {"exhausted_percent", f.percent(f.exhausted)},
          {"non_finite", f.non_finite},
          {"uv_texels", quantiles(f.uv_texels)},
          {"height", quantiles(f.height)}};
}

Progress::Progress(std::string label, std::size_t total)
    : label_(std::move(label)), total_(total), shown_(isatty(STDERR_FILENO) != 0) {}

void Progress::advance(const std::string& what) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (!shown_) return;
  constexpr std::size_t width = 30;
  std::size_t filled = total_ ? std::min(width, width * done_ / total_) : width;
  fmt::print(stderr, "\r\033[K{} [{:#<{}}{:.<{}}] {}/{} {}", label_, "", filled, "", width - filled, done_, total_,
             what);
}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

}  // namespace relievo::cli
