#include "describe/descriptor_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "describe/axis.hpp"
#include "describe/source_path.hpp"

namespace relievo {
namespace {

constexpr std::array<std::string_view, 2> type_names = {"float", "int"};

void check_range(TomlReader& table, const Parameter& parameter) {
  if (parameter.minimum > parameter.maximum) {
    table.report("describe.range",
                 fmt::format("\"min\" of the {} is {}, above its \"max\" {}", table.label(), parameter.minimum,
                             parameter.maximum),
                 "min");
  }
  if (parameter.value < parameter.minimum || parameter.value > parameter.maximum) {
    table.report("describe.range",
                 fmt::format("\"default\" of the {} is {}; a value from {} to {} is expected", table.label(),
                             parameter.value, parameter.minimum, parameter.maximum),
                 "default");
  }
}

void read_range(TomlReader& table, Parameter& parameter) {
  constexpr int largest = std::numeric_limits<int>::max();
  const int smallest = parameter.is_loop ? 0 : std::numeric_limits<int>::min();
  const auto read = [&](std::string_view key) {
    return parameter.is_integer ? table.integer(key, smallest, largest) : table.number(key);
  };
  parameter.minimum = read("min");
  parameter.maximum = read("max");
  parameter.value = read("default");
  check_range(table, parameter);
}

Parameter read_shared(TomlReader& table, const std::string& name) {
  Parameter parameter;
  parameter.name = name;
  parameter.title = table.text("title");
  parameter.binding = table.choice_of<BindingTime>("binding", binding_names, BindingTime::uniform);
  parameter.file = table.file();
  parameter.line = table.line();
  return parameter;
}

Parameter read_loop(TomlReader& table, const std::string& name) {
  table.allow_keys({"title", "bounds", "min", "max", "default", "binding"});
  Parameter loop = read_shared(table, name);
  loop.is_integer = loop.is_loop = true;
  loop.unit = table.text("bounds");
  read_range(table, loop);
  return loop;
}

Parameter read_parameter(TomlReader& table, const std::string& name) {
  table.allow_keys({"title", "unit", "type", "min", "max", "default", "binding"});
  Parameter parameter = read_shared(table, name);
  parameter.unit = table.text_or("unit", "1");
  parameter.is_integer = table.choice("type", type_names, 0) == 1;
  read_range(table, parameter);
  return parameter;
}

Parameter read_one_axis(TomlReader& table, const std::string& name, const std::string& owner) {
  table.allow_keys({"title", "values", "default", "binding", "software", "bindings", "maps", "features", "rule"});
  Parameter axis = read_shared(table, name);
  read_axis(table, owner, axis);
  return axis;
}

/// A name that a loop, a parameter or an axis before it has already.
void check_unused(TomlReader& table, const std::vector<Parameter>& parameters, const std::string& name) {
  const auto same = [&](const Parameter& parameter) { return parameter.name == name; };
  if (std::none_of(parameters.begin(), parameters.end(), same)) return;
  table.report(
      "describe.duplicate",
      fmt::format("the {} has the name of a loop or parameter; names are used once a descriptor", table.label()), "");
}

}  // namespace

std::string_view to_string(BindingTime time) {
  return binding_names[static_cast<std::size_t>(time)];
}

const FeatureSet& known_features() {
  static const FeatureSet features = {"dynamic_loops", "explicit_lod",   "texture_3d", "gather",
                                      "geometry",      "tessellation",   "compute",    "vertex_texture",
                                      "depth_write",   "extended_images"};
  return features;
}

void check_schema(TomlReader& descriptor) {
  if (!descriptor.has("schema")) return;
  const int schema = descriptor.integer("schema", 1, std::numeric_limits<int>::max());
  if (schema <= descriptor_schema) return;
  descriptor.report("describe.range",
                    fmt::format("\"schema\" of the {} is {}; this version reads schemas up to {}", descriptor.label(),
                                schema, descriptor_schema),
                    "schema");
}

std::string read_name(TomlReader& descriptor) {
  std::string name = descriptor.name("name");
  const std::string folder = file_name_of(folder_of(descriptor.file()));
  if (!folder.empty() && folder != name) {
    descriptor.report("describe.name",
                      fmt::format("\"name\" of the {} is {}; the name of its folder, {}, is expected",
                                  descriptor.label(), quote(name), quote(folder)),
                      "name");
  }
  return name;
}

std::vector<Parameter> read_parameters(TomlReader& descriptor, const std::string& owner) {
  std::vector<Parameter> parameters;
  for (auto& [name, table] : descriptor.named_tables("loops", "loop")) parameters.push_back(read_loop(table, name));
  for (auto& [name, table] : descriptor.named_tables("parameters", "parameter")) {
    check_unused(table, parameters, name);
    parameters.push_back(read_parameter(table, name));
  }
  for (auto& [name, table] : descriptor.named_tables("axes", "axis")) {
    check_unused(table, parameters, name);
    parameters.push_back(read_one_axis(table, name, owner));
  }
  return parameters;
}

FeatureSet read_features(TomlReader& descriptor) {
  const FeatureSet& known = known_features();
  const std::vector<std::string> features =
      descriptor.choices("features", {known.begin(), known.end()}, "describe.unknown-feature");
  return {features.begin(), features.end()};
}

}  // namespace relievo
