#include "compile/reflection.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

namespace relievo {

namespace {

using Json = nlohmann::ordered_json;
using spirv_cross::Compiler;
using spirv_cross::SPIRType;

void put(Json& object, const char* key, int slot) {
  if (slot != kNoSlot) object[key] = slot;
}

Json hlsl_slots(const HlslRegisters& registers) {
  Json slots = Json::object();
  const auto name = [&](const char* key, char letter, int number) {
    if (number != kNoSlot) slots[key] = fmt::format("{}{}", letter, number);
  };
  name("register", 'b', registers.b);
  name("register", 't', registers.t);
  name("register", 'u', registers.u);
  name("sampler_register", 's', registers.s);
  slots["space"] = 0;
  return slots;
}

Json msl_slots(const MslIndices& indices) {
  Json slots = Json::object();
  put(slots, "buffer", indices.buffer);
  put(slots, "texture", indices.texture);
  put(slots, "sampler", indices.sampler);
  return slots;
}

/// GLSL 330 and ESSL 300 have no layout(binding): the runtime looks the name up and assigns the slot.
bool binds_by_name(const Target& target) {
  return (target.language == Language::glsl && target.version < 420) ||
         (target.language == Language::essl && target.version < 310);
}

Json gl_slots(const Target& target, int slot) {
  return {{"slot", slot}, {"by", binds_by_name(target) ? "name" : "layout"}};
}

/// Where one resource lives on each emitted target. `spirv` is where SPIR-V has it.
Json target_slots(std::span<const Target> targets, const Json& spirv, int gl_slot, const HlslRegisters& hlsl,
                  const MslIndices& msl) {
  Json all = Json::object();
  for (const Target& target : targets) {
    Json& slots = all[to_string(target)];
    switch (target.language) {
      case Language::spirv:
        slots = spirv;
        break;
      case Language::glsl:
      case Language::essl:
        slots = gl_slots(target, gl_slot);
        break;
      case Language::hlsl:
        slots = hlsl_slots(hlsl);
        break;
      case Language::msl:
        slots = msl_slots(msl);
        break;
    }
  }
  return all;
}

Json stage_names(std::span<const ShaderStage> stages) {
  Json names = Json::array();
  for (const ShaderStage stage : stages) names.push_back(to_string(stage));
  return names;
}

Json bindings(const BindingLayout& layout, std::span<const Target> targets) {
  Json all = Json::array();
  for (const BoundResource& entry : layout.resources) {
    const BindingSlot& slot = entry.slot;
    Json json = {{"kind", to_string(slot.kind)}, {"set", slot.set},
                 {"binding", slot.binding},      {"name", slot.name},
                 {"count", entry.count},         {"stages", stage_names(entry.stages)},
                 {"gl_slot", slot.gl_slot}};
    if (slot.kind == ResourceKind::storage_buffer || slot.kind == ResourceKind::storage_texture) {
      json["read_only"] = entry.read_only;
    }
    if (slot.kind == ResourceKind::sampled_texture) json["filtered"] = slot.is_filtered;
    const Json spirv = {{"set", slot.set}, {"binding", slot.binding}};
    json["targets"] = target_slots(targets, spirv, slot.gl_slot, entry.hlsl, entry.msl);
    all.push_back(std::move(json));
  }
  return all;
}

Json push_constants(const BindingLayout& layout, std::span<const Target> targets) {
  if (!layout.push_constants) return nullptr;
  const PushConstants& push = *layout.push_constants;
  return {{"name", push.name},
          {"size", push.size},
          {"targets", target_slots(targets, {{"push_constant", true}}, push.gl_slot, push.hlsl, push.msl)}};
}

Json parameters(const ComposedProgram& program) {
  Json all = Json::array();
  for (const ParameterSlot& slot : program.parameters) {
    Json json = {{"name", slot.name},
                 {"type", slot.is_integer ? "int" : "float"},
                 {"binding", to_string(slot.binding)},
                 {"value", slot.value}};
    if (slot.is_integer) json["value"] = static_cast<std::int64_t>(slot.value);
    if (slot.binding == BindingTime::specialization) json["constant_id"] = slot.constant_id;
    if (slot.binding == BindingTime::uniform) json["offset"] = slot.offset;
    all.push_back(std::move(json));
  }
  return all;
}

Json maps(const ComposedProgram& program) {
  Json all = Json::array();
  for (const MapSlot& slot : program.maps) {
    all.push_back({{"map", slot.map}, {"sampler", slot.sampler}, {"set", slot.set}, {"binding", slot.binding}});
  }
  return all;
}

/// Type and default of a scalar constant.
std::pair<const char*, Json> constant_value(const Compiler& compiler, const spirv_cross::SPIRConstant& constant) {
  switch (compiler.get_type(constant.constant_type).basetype) {
    case SPIRType::Boolean:
      return {"bool", constant.scalar() != 0};
    case SPIRType::Int:
      return {"int", constant.scalar_i32()};
    case SPIRType::UInt:
      return {"uint", constant.scalar()};
    case SPIRType::Float:
      return {"float", constant.scalar_f32()};
    default:
      return {"other", nullptr};
  }
}

/// The union over the shaders, by constant_id. Targets that take text read the macro or function constant named here.
Json specialization_constants(std::span<const ShaderModule> modules) {
  std::map<std::uint32_t, Json> by_id;
  for (const ShaderModule& module : modules) {
    for (const auto& found : module.reflection->get_specialization_constants()) {
      const auto& constant = module.reflection->get_constant(found.id);
      auto [type, value] = constant_value(*module.reflection, constant);
      Json& json = by_id[found.constant_id];
      if (json.is_null()) {
        json = {{"constant_id", found.constant_id},
                {"name", module.reflection->get_name(found.id)},
                {"type", type},
                {"default", std::move(value)},
                {"macro", fmt::format("SPIRV_CROSS_CONSTANT_ID_{}", found.constant_id)},
                {"stages", Json::array()}};
      }
      json["stages"].push_back(to_string(module.stage));
    }
  }
  Json all = Json::array();
  for (auto& [id, json] : by_id) all.push_back(std::move(json));
  return all;
}

const char* input_primitive(const Compiler& compiler) {
  const auto& modes = compiler.get_execution_mode_bitset();
  if (modes.get(spv::ExecutionModeInputPoints)) return "points";
  if (modes.get(spv::ExecutionModeInputLines)) return "lines";
  if (modes.get(spv::ExecutionModeInputLinesAdjacency)) return "lines_adjacency";
  if (modes.get(spv::ExecutionModeInputTrianglesAdjacency)) return "triangles_adjacency";
  return "triangles";
}

const char* output_primitive(const Compiler& compiler) {
  const auto& modes = compiler.get_execution_mode_bitset();
  if (modes.get(spv::ExecutionModeOutputPoints)) return "points";
  if (modes.get(spv::ExecutionModeOutputLineStrip)) return "line_strip";
  return "triangle_strip";
}

Json geometry(const Compiler& compiler) {
  const auto invocations = compiler.get_execution_mode_argument(spv::ExecutionModeInvocations);
  return {{"input_primitive", input_primitive(compiler)},
          {"output_primitive", output_primitive(compiler)},
          {"max_vertices", compiler.get_execution_mode_argument(spv::ExecutionModeOutputVertices)},
          {"invocations", invocations == 0 ? 1u : invocations}};
}

Json local_size(const Compiler& compiler) {
  Json size = Json::array();
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    size.push_back(compiler.get_execution_mode_argument(spv::ExecutionModeLocalSize, axis));
  }
  return size;
}

Json shader(const ShaderModule& module) {
  Json json = {{"stage", to_string(module.stage)}, {"entry_point", "main"}};
  if (module.stage == ShaderStage::geometry) json["geometry"] = geometry(*module.reflection);
  if (module.stage == ShaderStage::compute) json["local_size"] = local_size(*module.reflection);
  // Emitting consumes the compiler, so SPIRV-Cross's own reflection comes from a fresh copy.
  json["spirv_cross"] = Json::parse(spirv_cross::CompilerReflection(*module.ir).compile());
  return json;
}

/// What a runtime must know of a target as a whole.
Json target_notes(std::span<const Target> targets, const BindingLayout& layout) {
  Json all = Json::object();
  for (const Target& target : targets) {
    Json& notes = all[to_string(target)];
    notes = {{"entry_point", target.language == Language::msl ? "main0" : "main"}};
    if (target.language == Language::msl) {
      notes["vertex_buffer"] = kMslVertexBuffer;
      notes["buffer_sizes_buffer"] = kMslBufferSizes;
    }
    if (target.language == Language::hlsl && layout.hlsl_workgroup_count != kNoSlot) {
      notes["workgroup_count_register"] = fmt::format("b{}", layout.hlsl_workgroup_count);
    }
  }
  return all;
}

}  // namespace

Result<std::string> make_reflection(const ComposedProgram& program, std::span<const ShaderModule> modules,
                                    const BindingLayout& layout, std::span<const Target> targets) {
  return catch_emit_errors("reflecting", program.key, [&]() -> Result<std::string> {
    Json json = {{"schema", kReflectionSchema}, {"key", program.key}, {"stage", program.stage}};
    json["features"] = program.features;
    json["maps"] = maps(program);
    json["parameters"] = parameters(program);
    json["parameter_block_size"] = program.parameter_block_size;
    json["bindings"] = bindings(layout, targets);
    json["push_constants"] = push_constants(layout, targets);
    json["specialization_constants"] = specialization_constants(modules);
    json["targets"] = target_notes(targets, layout);
    json["shaders"] = Json::array();
    for (const ShaderModule& module : modules) json["shaders"].push_back(shader(module));
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
  });
}

}  // namespace relievo
