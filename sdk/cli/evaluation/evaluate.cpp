#include <fmt/format.h>
#include <algorithm>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

namespace {

std::size_t steps_of(const EvaluationInput& input, std::size_t backends) {
  std::size_t angles = 0, drawing = 0;
  for (const RayCase& c : input.ray_cases) angles += c.angles.size();
  for (const auto& [name, stage] : input.registry->stages) drawing += stage.mesh != "none";
  return backends * (2 * angles + input.scenes.size() * (drawing + 1));
}

}  // namespace

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
  const std::pair<const char*, decltype(&evaluate_rays)> parts[] = {
      {"rays", evaluate_rays}, {"pictures", evaluate_pictures}, {"cracks", evaluate_cracks}};
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
  input.values = settings->values;
  for (const std::string& scene : scenes) {
    Result<LoadedScene> parts = load_scene_parts(scene);
    if (!parts) return tl::unexpected(parts.error());
    input.scenes.emplace_back(std::filesystem::path(scene).stem().string(), std::move(*parts));
  }
  for (const std::string& item : heights) {
    RayCase ray_case;
    std::size_t colon = item.rfind(':');
    std::string path = item;
    if (colon != std::string::npos && item.find_first_not_of("0123456789.eE+-", colon + 1) == std::string::npos &&
        colon + 1 < item.size()) {
      path = item.substr(0, colon);
      ray_case.scale = std::strtod(item.c_str() + colon + 1, nullptr);
    }
    Result<HeightMap> height = load_height(path, address);
    if (!height) return tl::unexpected(height.error());
    ray_case.name = std::filesystem::path(path).stem().string();
    ray_case.height = std::move(*height);
    input.ray_cases.push_back(std::move(ray_case));
  }
  return input;
}

}  // namespace relievo::cli
