/// relievo describe: all that a descriptor says.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common.hpp"
#include "describe/description.hpp"

namespace relievo::cli {

namespace {

Result<nlohmann::json> find(const Registry& registry, const std::string& name) {
  if (auto t = registry.techniques.find(name); t != registry.techniques.end()) return description_of(t->second);
  if (auto m = registry.maps.find(name); m != registry.maps.end()) return description_of(m->second);
  if (auto s = registry.stages.find(name); s != registry.stages.end()) return description_of(s->second);
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
    const std::string name = p["name"].get<std::string>(), note = text(p["title"]) + ", " + text(p["binding"]);
    if (p.contains("values")) {
      const auto values = p["values"].get<std::vector<std::string>>();
      fmt::print("  {:<16} {} = {} ({})\n", name, fmt::join(values, " | "), values.at(p["default"].get<std::size_t>()),
                 note);
      continue;
    }
    const auto number = [&](const char* key) { return fmt::format("{}", p[key].get<double>()); };
    fmt::print("  {:<16} {} = {} in [{}, {}]{} ({})\n", name, text(p["type"]), number("default"), number("min"),
               number("max"), text(p["unit"]).empty() ? "" : " " + text(p["unit"]), note);
  }
}

Status run_describe(const Context& context, const std::string& name) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  Result<nlohmann::json> description = find(*registry, name);
  if (!description) return tl::unexpected(description.error());
  if (context.json) {
    print_json(*description);
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
