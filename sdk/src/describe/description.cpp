#include "describe/description.hpp"

namespace relievo {

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
    if (p.software_value) list.back()["software"] = value_text(p, *p.software_value);
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

}  // namespace

nlohmann::json description_of(const TechniqueDescriptor& t) {
  nlohmann::json json = common_json(t, "technique");
  json.update({{"class", to_string(t.technique_class)},
               {"first_hit", to_string(t.first_hit)},
               {"maps", t.maps},
               {"module", t.module}});
  return json;
}

nlohmann::json description_of(const MapDescriptor& m) {
  nlohmann::json json = common_json(m, "map");
  json.update({{"inputs", m.inputs},
               {"channels", m.channels},
               {"levels", to_string(m.levels)},
               {"passes", m.passes},
               {"sampler", m.sampler},
               {"set", m.set},
               {"binding", m.binding},
               {"module", m.module},
               {"access", m.access}});
  return json;
}

nlohmann::json description_of(const StageDescriptor& s) {
  nlohmann::json json = common_json(s, "stage");
  nlohmann::json shaders = nlohmann::json::array();
  for (const StageShader& shader : s.shaders)
    shaders.push_back({{"stage", to_string(shader.stage)}, {"module", shader.module}});
  json.update({{"roles", s.roles},
               {"maps", s.maps},
               {"mesh", s.mesh},
               {"hits", s.hits_within_tile ? "within_tile" : "continuous"},
               {"fallback", s.fallback},
               {"shaders", shaders}});
  return json;
}

}  // namespace relievo
