/// relievo list: what there is.
#include <fmt/format.h>

#include "common.hpp"

namespace relievo::cli {

namespace {

nlohmann::json list_techniques(const Registry& registry) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [name, t] : registry.techniques) {
    list.push_back({{"name", name},
                    {"title", t.title},
                    {"class", to_string(t.technique_class)},
                    {"first_hit", to_string(t.first_hit)}});
  }
  return list;
}

nlohmann::json list_maps(const Registry& registry) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [name, m] : registry.maps)
    list.push_back({{"name", name}, {"title", m.title}, {"inputs", m.inputs}, {"channels", m.channels}});
  return list;
}

nlohmann::json list_stages(const Registry& registry) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [name, s] : registry.stages)
    list.push_back({{"name", name}, {"title", s.title}, {"roles", s.roles}, {"mesh", s.mesh}});
  return list;
}

nlohmann::json backend_list() {
  nlohmann::json list = nlohmann::json::array();
  for (const BackendInfo& info : list_backends()) {
    nlohmann::json entry = {{"name", info.name}, {"title", info.title}, {"available", info.available}};
    if (info.available) {
      entry.update({{"device", info.device},
                    {"driver", info.driver},
                    {"api_version", info.api_version},
                    {"shader_target", info.shader_target},
                    {"features", info.features}});
    } else {
      entry["reason"] = info.reason;
    }
    list.push_back(std::move(entry));
  }
  list.push_back({{"name", "oracle"}, {"title", "Exact first hits on the CPU, double precision"}, {"available", true}});
  return list;
}

nlohmann::json target_list() {
  nlohmann::json list = nlohmann::json::array();
  for (const Target& target : all_targets()) list.push_back({{"name", to_string(target)}});
  return list;
}

void print(const nlohmann::json& lists) {
  for (const auto& [kind, list] : lists.items()) {
    fmt::print("{}\n", kind);
    for (const auto& entry : list) {
      std::string text = entry.value("title", "");
      if (entry.contains("class"))
        text += fmt::format(" ({}; first hit: {})", entry["class"].get<std::string>(),
                            entry["first_hit"].get<std::string>());
      if (entry.contains("device")) text += fmt::format(": {}", entry["device"].get<std::string>());
      if (entry.contains("features"))
        text += fmt::format(" ({})", fmt::join(entry["features"].get<std::vector<std::string>>(), ", "));
      if (entry.contains("reason")) text += fmt::format(": not available: {}", entry["reason"].get<std::string>());
      fmt::print("  {:<20} {}\n", entry["name"].get<std::string>(), text);
    }
  }
}

Status run_list(const Context& context, const std::string& kind) {
  Result<Registry> registry = context.registry();
  if (!registry) return tl::unexpected(registry.error());
  nlohmann::json lists;
  bool all = kind == "all";
  if (all || kind == "techniques") lists["techniques"] = list_techniques(*registry);
  if (all || kind == "maps") lists["maps"] = list_maps(*registry);
  if (all || kind == "stages") lists["stages"] = list_stages(*registry);
  if (all || kind == "targets") lists["targets"] = target_list();
  if (all || kind == "backends") lists["backends"] = backend_list();
  if (context.json) {
    print_json(lists);
  } else {
    print(lists);
  }
  return {};
}

}  // namespace

void add_list(CLI::App& app, Context& context) {
  auto kind = std::make_shared<std::string>("all");
  CLI::App* command = add_command(app, context, "list", "List techniques, maps, stages, targets and backends",
                                  [&context, kind] { return run_list(context, *kind); });
  command->add_option("kind", *kind, "What to list")
      ->check(CLI::IsMember({"all", "techniques", "maps", "stages", "targets", "backends"}))
      ->capture_default_str();
}

}  // namespace relievo::cli
