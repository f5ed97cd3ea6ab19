#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "describe/descriptor_fields.hpp"

namespace relievo {
namespace {

constexpr std::array<std::string_view, 4> mesh_names = {"none", "base", "tessellated", "prisms"};
constexpr std::array<std::string_view, 2> hits_names = {"continuous", "within_tile"};

/// In pipeline order, which is the order of ShaderStage.
const std::array<std::string_view, 6>& shader_stage_names() {
  static const std::array<std::string_view, 6> names = {to_string(ShaderStage::vertex),
                                                        to_string(ShaderStage::tessellation_control),
                                                        to_string(ShaderStage::tessellation_evaluation),
                                                        to_string(ShaderStage::geometry),
                                                        to_string(ShaderStage::fragment),
                                                        to_string(ShaderStage::compute)};
  return names;
}

bool has_shader(const StageDescriptor& stage, ShaderStage wanted) {
  return std::any_of(stage.shaders.begin(), stage.shaders.end(),
                     [&](const StageShader& shader) { return shader.stage == wanted; });
}

/// A shader's place in the list is checked against the one before: later in the pipeline, and compute on its own.
void check_order(TomlReader& reader, const StageDescriptor& stage, ShaderStage next) {
  if (stage.shaders.empty()) return;
  const ShaderStage last = stage.shaders.back().stage;
  if (next == last) {
    reader.report("describe.duplicate",
                  fmt::format("the {} is a second {} shader; one each is expected", reader.label(), to_string(next)),
                  "stage");
  } else if (next == ShaderStage::compute || last == ShaderStage::compute) {
    reader.report("describe.range", "a compute shader stands beside others; a stage is either compute or graphics",
                  "stage");
  } else if (next < last) {
    reader.report("describe.range",
                  fmt::format("the {} is a {} shader after the {} shader; pipeline order is expected", reader.label(),
                              to_string(next), to_string(last)),
                  "stage");
  }
}

void read_shaders(TomlReader& reader, StageDescriptor& stage) {
  for (TomlReader& table : reader.table_list("shader")) {
    table.allow_keys({"stage", "module"});
    const auto kind = table.choice_of<ShaderStage>("stage", shader_stage_names());
    check_order(table, stage, kind);
    stage.shaders.push_back({kind, table.path("module")});
  }
}

void check_pipeline(TomlReader& reader, const StageDescriptor& stage) {
  if (has_shader(stage, ShaderStage::compute)) return;
  for (const ShaderStage required : {ShaderStage::vertex, ShaderStage::fragment}) {
    if (has_shader(stage, required)) continue;
    reader.report("describe.missing-key", fmt::format("the graphics stage lacks a {} shader", to_string(required)),
                  "shader");
  }
  if (has_shader(stage, ShaderStage::tessellation_control) != has_shader(stage, ShaderStage::tessellation_evaluation)) {
    reader.report("describe.missing-key", "the stage has one tessellation shader; control and evaluation are expected",
                  "shader");
  }
}

/// What the shaders themselves say need not be written twice.
void imply_features(StageDescriptor& stage) {
  if (has_shader(stage, ShaderStage::geometry)) stage.features.insert("geometry");
  if (has_shader(stage, ShaderStage::tessellation_control)) stage.features.insert("tessellation");
  if (has_shader(stage, ShaderStage::compute)) stage.features.insert("compute");
}

void read_mesh(TomlReader& reader, StageDescriptor& stage) {
  const bool is_compute = has_shader(stage, ShaderStage::compute);
  const std::size_t mesh = reader.choice("mesh", mesh_names, is_compute ? 0 : 1);
  stage.mesh = mesh_names[mesh];
  if ((mesh == 0) != is_compute) {
    reader.report("describe.range",
                  fmt::format("\"mesh\" of the {} stage is {}; {} is expected", is_compute ? "compute" : "graphics",
                              quote(stage.mesh), is_compute ? "\"none\"" : "a mesh"),
                  "mesh");
  }
}

void read_stage(TomlReader& reader, StageDescriptor& stage) {
  reader.allow_keys({"schema", "name", "title", "source", "summary", "roles", "maps", "features", "fallback", "mesh",
                     "hits", "shader", "loops", "parameters", "axes"});
  stage.roles = reader.names("roles");
  stage.maps = reader.names("maps");
  stage.features = read_features(reader);
  if (reader.has("fallback")) stage.fallback = reader.name("fallback");
  read_shaders(reader, stage);
  check_pipeline(reader, stage);
  read_mesh(reader, stage);
  stage.hits_within_tile = reader.choice("hits", hits_names, 0) == 1;
  imply_features(stage);
}

}  // namespace

Result<StageDescriptor> parse_stage(std::string_view text, const std::string& path) {
  return parse_descriptor<StageDescriptor>(text, path, "stage", read_stage);
}

}  // namespace relievo
