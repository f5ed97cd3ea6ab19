#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "describe/descriptor_fields.hpp"

namespace relievo {
namespace {

constexpr std::array<std::string_view, 2> level_names = {"single", "pyramid"};

bool is_glsl_identifier(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_allowed = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.size() <= 64 && is_letter(name[0]) &&
         std::all_of(name.begin(), name.end(), is_allowed) && !name.starts_with("gl_") && name.find("__") == name.npos;
}

std::string read_sampler(TomlReader& reader) {
  const std::string sampler = reader.text("sampler");
  if (!is_glsl_identifier(sampler)) {
    reader.report("describe.name",
                  fmt::format("\"sampler\" of the map is {}; a GLSL identifier without \"gl_\" and \"__\" is expected",
                              quote(sampler)),
                  "sampler");
  }
  return sampler;
}

/// Set 0 is the stage's own. Vulkan guarantees four sets; bindings stay small enough for every target's registers.
void read_binding(TomlReader& reader, MapDescriptor& map) {
  TomlReader binding = reader.table("binding", "binding");
  binding.allow_keys({"set", "binding"});
  map.set = binding.integer("set", 1, 3);
  map.binding = binding.integer("binding", 0, 127);
}

void read_map(TomlReader& reader, MapDescriptor& map) {
  reader.allow_keys({"schema", "name", "title", "source", "summary", "inputs", "channels", "levels", "sampler",
                     "binding", "module", "access", "features", "loops", "parameters"});
  map.inputs = reader.names("inputs");
  map.channels = reader.integer("channels", 1, 4);
  map.levels = reader.choice_of<MapLevels>("levels", level_names, MapLevels::single);
  map.sampler = read_sampler(reader);
  read_binding(reader, map);
  map.module = reader.path_or_empty("module");
  map.access = reader.path_or_empty("access");
  map.features = read_features(reader);
  if (map.module.empty() && !map.inputs.empty()) {
    reader.report("describe.missing-key",
                  "the map has \"inputs\" but lacks the key \"module\", the shader that bakes it from them", "inputs");
  }
}

}  // namespace

std::string_view to_string(MapLevels levels) {
  return level_names[static_cast<std::size_t>(levels)];
}

Result<MapDescriptor> parse_map(std::string_view text, const std::string& path) {
  return parse_descriptor<MapDescriptor>(text, path, "map", read_map);
}

}  // namespace relievo
