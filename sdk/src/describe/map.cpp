#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "describe/descriptor_fields.hpp"

namespace relievo {
namespace {

constexpr std::array<std::string_view, 3> level_names = {"single", "pyramid", "coarse_pyramid"};
constexpr std::array<std::string_view, 3> dimension_names = {"2d", "2d_array", "3d"};
constexpr std::array<std::string_view, 4> rounding_names = {"nearest", "up", "down", "exact"};
constexpr std::array<std::string_view, 2> texel_names = {"unorm", "uint"};
constexpr std::array<std::string_view, 10> image_formats = {"r8",     "rg8",  "rgba8", "r16",     "rg16",
                                                            "rgba16", "r32f", "rg32f", "rgba32f", "rgba16ui"};
constexpr int max_layers = 256, max_layers_at_once = 16, max_passes = 256;
constexpr std::size_t max_phases = 16;

bool is_glsl_identifier(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_allowed = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.size() <= 64 && is_letter(name[0]) &&
         std::all_of(name.begin(), name.end(), is_allowed) && !name.starts_with("gl_") && name.find("__") == name.npos;
}

std::string read_sampler(TomlReader& reader) {
  std::string sampler = reader.text("sampler");
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

/// A number, or the name of the parameter that holds it.
void read_layers(TomlReader& reader, MapDescriptor& map) {
  map.dimension = reader.choice_of<MapDimension>("dimension", dimension_names, MapDimension::flat);
  if (map.dimension == MapDimension::flat) {
    for (std::string_view key : {"layers", "layers_parameter"}) {
      if (reader.has(key)) {
        reader.report("describe.range",
                      fmt::format("only a map of dimension \"2d_array\" or \"3d\" has {}", quote(key)), key);
      }
    }
    return;
  }
  if (map.levels != MapLevels::single) {
    reader.report("describe.range", "a map with layers has the levels \"single\"", "levels");
  }
  if (reader.has("layers_parameter")) {
    map.layers_parameter = reader.name("layers_parameter");
  } else {
    map.layers = reader.integer("layers", 1, max_layers);
  }
}

/// One word a channel: "up down".
void read_rounding(TomlReader& reader, MapDescriptor& map) {
  std::istringstream words(reader.text_or("rounding", ""));
  for (std::string word; words >> word;) {
    const auto found = std::find(rounding_names.begin(), rounding_names.end(), word);
    if (found == rounding_names.end()) {
      reader.report(
          "describe.range",
          fmt::format("\"rounding\" has {}; expected \"nearest\", \"up\", \"down\" or \"exact\" for each channel",
                      quote(word)),
          "rounding");
      return;
    }
    map.rounding.push_back(static_cast<Rounding>(found - rounding_names.begin()));
  }
  if (!map.rounding.empty() && map.rounding.size() != static_cast<std::size_t>(map.channels)) {
    reader.report(
        "describe.range",
        fmt::format("\"rounding\" has {} words; expected {}, one a channel", map.rounding.size(), map.channels),
        "rounding");
  }
}

void read_passes(TomlReader& reader, MapDescriptor& map) {
  if (!reader.has("passes")) return;
  map.passes = reader.integers("passes", 1, max_passes);
  if (map.passes.size() <= max_phases) return;
  reader.report("describe.range",
                fmt::format("\"passes\" has {} phases; expected at most {}", map.passes.size(), max_phases), "passes");
}

void read_map(TomlReader& reader, MapDescriptor& map) {
  reader.allow_keys({"schema",           "name",     "title",        "source",         "summary",
                     "inputs",           "channels", "levels",       "dimension",      "layers",
                     "layers_parameter", "passes",   "layers_apart", "layers_at_once", "rounding",
                     "texels",           "sampler",  "image",        "binding",        "module",
                     "access",           "features", "loops",        "parameters",     "axes"});
  map.inputs = reader.names("inputs");
  map.channels = reader.integer("channels", 1, 4);
  map.levels = reader.choice_of<MapLevels>("levels", level_names, MapLevels::single);
  read_layers(reader, map);
  read_rounding(reader, map);
  read_passes(reader, map);
  map.layers_apart = reader.choices("layers_apart", {"repeat", "mirror", "clamp", "clip"}, "describe.range");
  if (reader.has("layers_at_once")) map.layers_at_once = reader.integer("layers_at_once", 1, max_layers_at_once);
  map.is_uint = reader.choice("texels", texel_names, 0) == 1;
  map.sampler = read_sampler(reader);
  if (reader.has("image")) map.image = image_formats[reader.choice("image", image_formats, 0)];
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

std::string_view to_string(MapDimension dimension) {
  return dimension_names[static_cast<std::size_t>(dimension)];
}

std::string_view to_string(Rounding rounding) {
  return rounding_names[static_cast<std::size_t>(rounding)];
}

namespace {

auto find_parameter(const MapDescriptor& map, std::string_view name) {
  return std::find_if(map.parameters.begin(), map.parameters.end(),
                      [&](const Parameter& parameter) { return parameter.name == name; });
}

/// What the host reads from the map's own parameters: the number of layers and of bits.
Status check_host_parameter(const MapDescriptor& map, std::string_view name, int most) {
  const auto found = find_parameter(map, name);
  const bool is_there = found != map.parameters.end();
  if (is_there && found->is_integer && found->minimum >= 1 && found->maximum <= most) return {};
  return fail(
      ErrorCode::usage, "describe.map-parameter",
      fmt::format("map {} lacks the integer parameter {} with values in 1 to {}", quote(map.name), quote(name), most),
      map.file, is_there ? found->line : 1, 1);
}

/// Whole numbers are there as textures of four channels of 16 bits.
Status check_whole_numbers(const MapDescriptor& map) {
  if (!map.is_uint) return {};
  const auto bits = find_parameter(map, "bits");
  const bool has_16_bits = bits != map.parameters.end() && bits->minimum == 16 && bits->maximum == 16;
  if (map.channels == 4 && !map.rounding.empty() && has_16_bits) return {};
  return fail(ErrorCode::usage, "describe.map-parameter",
              fmt::format("map {} has the texels \"uint\" but not four channels, the key \"rounding\" and a parameter "
                          "\"bits\" whose only value is 16",
                          quote(map.name)),
              map.file, 1, 1);
}

/// A map that can be read as an image has the axis that says whether it is.
Status check_image(const MapDescriptor& map) {
  if (map.image.empty()) return {};
  const auto fetch = find_parameter(map, "fetch");
  if (fetch != map.parameters.end() &&
      std::find(fetch->choices.begin(), fetch->choices.end(), "image") != fetch->choices.end())
    return {};
  return fail(
      ErrorCode::usage, "describe.map-parameter",
      fmt::format("map {} has the key \"image\" but lacks an axis \"fetch\" with the value \"image\"", quote(map.name)),
      map.file, 1, 1);
}

}  // namespace

Result<MapDescriptor> parse_map(std::string_view text, const std::string& path) {
  Result<MapDescriptor> map = parse_descriptor<MapDescriptor>(text, path, "map", read_map);
  if (!map) return map;
  if (!map->layers_parameter.empty()) {
    if (Status status = check_host_parameter(*map, map->layers_parameter, max_layers); !status)
      return tl::unexpected(status.error());
  }
  if (!map->rounding.empty()) {
    if (Status status = check_host_parameter(*map, "bits", 32); !status) return tl::unexpected(status.error());
  }
  if (Status status = check_whole_numbers(*map); !status) return tl::unexpected(status.error());
  if (Status status = check_image(*map); !status) return tl::unexpected(status.error());
  return map;
}

}  // namespace relievo
