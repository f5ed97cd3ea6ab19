/// relievo describe: all that a descriptor says.
#include <fmt/format.h>

#include "common.hpp"

namespace relievo::cli {

namespace {

nlohmann::json parameters_json(const std::vector<Parameter>& parameters) {
  nlohmann::json list = nlohmann::json::array();
  for (const Parameter& p : parameters) {
    list.push_back({{"name", p.name},
                    {"title", p.title},
                    {"kind", p.is_loop            ? "loop"
                             : !p.choices.empty() ? "axis"
                                                  : "parameter"},
                    {"type", p.is_integer ? "int" : "float"},
                    {"unit", p.unit},
                    {"min", p.minimum},
                    {"max", p.maximum},
                    {"default", p.value},
                    {"binding", to_string(p.binding)}});
    if (p.choices.empty()) continue;
    nlohmann::json rules = nlohmann::json::array();
    for (const Rule& rule : p.rules) rules.push_back(to_string(rule));
    list.back().update({{"values", p.choices}, {"maps", p.maps}, {"features", p.features}, {"rules", rules}});
  }
  return list;
}

template <class Descriptor>
nlohmann::json common_json(const Descriptor& d, const char* kind) {
  return {{"kind", kind},
          {"name", d.name},
          {"title", d.title},
          {"source", d.source},
          {"summary", d.summary},
          {"features", d.features},
          {"parameters", parameters_json(d.parameters)},
          {"file", d.file}};
}

nlohmann::json describe(const TechniqueDescriptor& t) {
  nlohmann::json json = common_json(t, "technique");
  json.update({{"class", to_string(t.technique_class)},
               {"first_hit", to_string(t.first_hit)},
               {"maps", t.maps},
               {"module", t.module}});
  return json;
}

nlohmann::json describe(const MapDescriptor& m) {
  nlohmann::json json = common_json(m, "map");
  json.update({{"inputs", m.inputs},
               {"channels", m.channels},
               {"levels", to_string(m.levels)},
               {"sampler", m.sampler},
               {"set", m.set},
               {"binding", m.binding},
               {"module", m.module},
               {"access", m.access}});
  return json;
}

nlohmann::json describe(const StageDescriptor& s) {
  nlohmann::json json = common_json(s, "stage");
  nlohmann::json shaders = nlohmann::json::array();
  for (const StageShader& shader : s.shaders)
    shaders.push_back({{"stage", to_string(shader.stage)}, {"module", shader.module}});
  json.update({{"roles", s.roles}, {"maps", s.maps}, {"mesh", s.mesh}, {"fallback", s.fallback}, {"shaders", shaders}});
  return json;
}

Result<nlohmann::json> find(const Registry& registry, const std::string& name) {
  if (auto t = registry.techniques.find(name); t != registry.techniques.end()) return describe(t->second);
  if (auto m = registry.maps.find(name); m != registry.maps.end()) return describe(m->second);
  if (auto s = registry.stages.find(name); s != registry.stages.end()) return describe(s->second);
  std::vector<std::string> known;
  for (const auto& entry : registry.techniques) known.push_back(entry.first);
  for (const auto& entry : registry.maps) known.push_back(entry.first);
  for (const auto& entry : registry.stages) known.push_back(entry.first);
  std::string nearest = nearest_name(name, known);
  return fail(ErrorCode::usage, "describe.unknown-name",
              fmt::format("'{}' is no technique, map or stage{}", name,
                          nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

void print(const nlohmann::json& d) {
  auto text = [](const nlohmann::json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); };
  for (const auto& [key, value] : d.items()) {
    if (key == "parameters" || value.empty()) continue;
    fmt::print("{:<10} {}\n", key, text(value));
  }
  for (const auto& p : d["parameters"]) {
    fmt::print("  {:<16} {} = {} in [{}, {}] {} ({}, {})\n", p["name"].get<std::string>(), text(p["type"]),
               text(p["default"]), text(p["min"]), text(p["max"]), text(p["unit"]), text(p["title"]),
               text(p["binding"]));
  }
}

Status run_describe(const Context& context, const std::string& name) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  Result<nlohmann::json> description = find(*registry, name);
  if (!description) return tl::unexpected(description.error());
  if (context.json) {
    fmt::print("{}\n", description->dump(2));
  } else {
    print(*description);
  }
  return {};
}

}  // namespace

void add_describe(CLI::App& app, Context& context) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = add_command(app, context, "describe", "Describe a technique, map or stage",
                                  [&context, name] { return run_describe(context, *name); });
  command->add_option("name", *name, "Technique, map or stage")->required();
}

}  // namespace relievo::cli
