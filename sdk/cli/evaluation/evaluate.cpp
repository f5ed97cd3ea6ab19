#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

namespace {

std::size_t steps_of(const EvaluationInput& input, std::size_t backends) {
  std::size_t angles = 0, drawing = 0;
  for (const RayCase& c : input.ray_cases) angles += c.angles.size();
  for (const auto& [name, stage] : input.registry->stages) drawing += stage.mesh != "none";
  return backends * (input.filters.size() * angles + input.scenes.size() * (drawing + 1));
}

}  // namespace

std::string unlike_others(const std::string& stem, const std::function<bool(const std::string&)>& is_taken) {
  std::string name = stem;
  for (int i = 2; is_taken(name); ++i) name = fmt::format("{}-{}", stem, i);
  return name;
}

bool is_name_of(const std::vector<RayCase>& cases, const std::string& name) {
  return std::any_of(cases.begin(), cases.end(), [&](const RayCase& c) { return c.name == name; });
}

Result<std::string> split_scale(const std::string& item, double& scale) {
  const std::size_t colon = item.rfind(':');
  std::error_code ignored;
  if (std::filesystem::exists(item, ignored) || colon == std::string::npos || colon + 1 == item.size() ||
      item.find_first_not_of("0123456789.eE+-", colon + 1) != std::string::npos)
    return item;
  const char* const last = item.data() + item.size();
  const char* const first = item.data() + colon + 1;
  const auto [end, error] = std::from_chars(*first == '+' ? first + 1 : first, last, scale);
  if (error == std::errc() && end == last && scale > 0 && std::isfinite(scale)) return item.substr(0, colon);
  return fail(ErrorCode::usage, "cli.scale",
              fmt::format("--height {}: '{}' is no scale; expected FILE or FILE:scale with a positive number", item,
                          item.substr(colon + 1)));
}

Result<OpenBackends> open_backends(const std::vector<std::string>& names, std::vector<BackendInfo>& infos,
                                   std::vector<NotRun>& not_run) {
  OpenBackends backends;
  for (const std::string& name : names) {
    Result<std::unique_ptr<Backend>> backend = open(name, true);
    if (!backend && backend.error().code == ErrorCode::unsupported) {
      not_run.push_back({"backend " + name, backend.error().message});
      continue;
    }
    if (!backend) return tl::unexpected(backend.error());
    infos.push_back((*backend)->info());
    backends[name] = std::move(*backend);
  }
  if (!backends.empty()) return backends;
  return fail(ErrorCode::unsupported, "evaluation.no-backend",
              fmt::format("no backend is available: {}", not_run.empty() ? "none was named" : not_run.front().reason));
}

Result<Evaluation> evaluate(const EvaluationInput& input) {
  Evaluation evaluation;
  std::vector<BackendInfo> infos;
  Result<OpenBackends> opened = open_backends(input.backends, infos, evaluation.not_run);
  if (!opened) return tl::unexpected(opened.error());
  OpenBackends& backends = *opened;
  for (const BackendInfo& info : infos) evaluation.backends.push_back({info, own_values(*input.registry, info)});
  Progress progress("evaluate", steps_of(input, backends.size()));
  input.clock->end("starting");
  const std::pair<const char*, decltype(&evaluate_rays)> parts[] = {{"rays", evaluate_rays},
                                                                    {"pictures", evaluate_pictures}};
  for (const auto& [name, part] : parts) {
    if (Status status = part(input, backends, evaluation, progress); !status) return tl::unexpected(status.error());
    input.clock->end(name);
  }
  judge(input, evaluation);
  return evaluation;
}

Result<EvaluationInput> make_input(const Registry& registry, const std::vector<std::string>& techniques,
                                   const std::vector<std::string>& scenes, const std::vector<std::string>& heights,
                                   const std::string& address, const std::vector<std::string>& set) {
  EvaluationInput input;
  input.registry = &registry;
  Result<std::vector<std::string>> names = technique_names(registry, techniques);
  if (!names) return tl::unexpected(names.error());
  input.techniques = *names;
  Result<Settings> settings = parse_settings(registry, set, names->size() == 1 ? names->front() : "");
  if (!settings) return tl::unexpected(settings.error());
  if (!settings->filters.empty()) {
    return fail(ErrorCode::usage, "cli.set",
                fmt::format("--set {}.filter=…: filters cannot be set here; every technique is tried with those it has",
                            settings->filters.begin()->first));
  }
  input.values = settings->values;
  for (const std::string& scene : scenes) {
    Result<LoadedScene> parts = load_scene_parts(scene);
    if (!parts) return tl::unexpected(parts.error());
    const auto is_taken = [&](const std::string& name) {
      return std::any_of(input.scenes.begin(), input.scenes.end(),
                         [&](const auto& other) { return other.first == name; });
    };
    input.scenes.emplace_back(unlike_others(std::filesystem::path(scene).stem().string(), is_taken), std::move(*parts));
  }
  for (const std::string& item : heights) {
    RayCase ray_case;
    const Result<std::string> path = split_scale(item, ray_case.scale);
    if (!path) return tl::unexpected(path.error());
    Result<HeightMap> height = load_height(*path, address);
    if (!height) return tl::unexpected(height.error());
    ray_case.name = unlike_others(std::filesystem::path(*path).stem().string(),
                                  [&](const std::string& name) { return is_name_of(input.ray_cases, name); });
    ray_case.height = std::move(*height);
    input.ray_cases.push_back(std::move(ray_case));
  }
  return input;
}

}  // namespace relievo::cli
