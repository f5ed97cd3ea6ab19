#include "compile/interface.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace relievo {

namespace {

using spirv_cross::Compiler;
using spirv_cross::Resource;

/// A varying's location; a block's is its first member's.
int location_of(const Compiler& compiler, const Resource& varying) {
  if (!compiler.has_decoration(varying.id, spv::DecorationLocation) &&
      !compiler.get_type(varying.base_type_id).member_types.empty()) {
    return static_cast<int>(compiler.get_member_decoration(varying.base_type_id, 0, spv::DecorationLocation));
  }
  return static_cast<int>(compiler.get_decoration(varying.id, spv::DecorationLocation));
}

std::string varying_name(const Compiler& compiler, const Resource& varying, ShaderStage producer) {
  std::string name = fmt::format("relievo_{}_out_{}", to_string(producer), location_of(compiler, varying));
  if (compiler.has_decoration(varying.id, spv::DecorationPatch)) name += "_patch";
  const auto component = compiler.get_decoration(varying.id, spv::DecorationComponent);
  if (component != 0) name += fmt::format("_{}", component);
  return name;
}

void rename(Compiler& compiler, const Resource& varying, ShaderStage producer) {
  const std::string name = varying_name(compiler, varying, producer);
  compiler.set_name(varying.id, name);
  const bool is_block = compiler.has_decoration(varying.base_type_id, spv::DecorationBlock);
  if (is_block) compiler.set_name(varying.base_type_id, name + "_block");
}

std::set<int> locations(const ShaderModule& module, const spirv_cross::SmallVector<Resource>& varyings) {
  std::set<int> found;
  for (const Resource& varying : varyings) found.insert(location_of(*module.reflection, varying));
  return found;
}

/// Blocks, arrays and matrices take several locations; they are never treated as unread.
bool takes_one_location(const ShaderModule& module, const Resource& varying) {
  const auto& type = module.reflection->get_type(varying.type_id);
  return type.array.empty() && type.columns == 1 && type.member_types.empty();
}

std::set<int> unread_outputs(const ShaderModule& producer, const ShaderModule& consumer) {
  const std::set<int> read = locations(consumer, consumer.resources.stage_inputs);
  const bool reads_many = !std::all_of(consumer.resources.stage_inputs.begin(), consumer.resources.stage_inputs.end(),
                                       [&](const Resource& input) { return takes_one_location(consumer, input); });
  if (reads_many) return {};
  std::set<int> unread;
  for (const Resource& output : producer.resources.stage_outputs) {
    const int location = location_of(*producer.reflection, output);
    if (read.count(location) == 0 && takes_one_location(producer, output)) unread.insert(location);
  }
  return unread;
}

/// The stage after, or null.
const ShaderModule* next_stage(std::span<const ShaderModule> modules, const ShaderModule& module) {
  const ShaderModule* next = nullptr;
  for (const ShaderModule& other : modules) {
    if (other.stage <= module.stage) continue;
    if (next == nullptr || other.stage < next->stage) next = &other;
  }
  return next;
}

/// A varying's type without the array over the vertices that some stages see.
struct VaryingType {
  spirv_cross::SPIRType::BaseType base = spirv_cross::SPIRType::Unknown;
  std::uint32_t components = 0, columns = 0;
  friend bool operator==(const VaryingType&, const VaryingType&) = default;
};

VaryingType type_of(const ShaderModule& module, const Resource& varying) {
  const auto& type = module.reflection->get_type(varying.base_type_id);
  return {type.basetype, type.vecsize, type.columns};
}

Status check_interface(const ShaderModule& producer, const ShaderModule& consumer, std::string_view key) {
  for (const Resource& input : consumer.resources.stage_inputs) {
    const int location = location_of(*consumer.reflection, input);
    const auto& outputs = producer.resources.stage_outputs;
    const auto output = std::find_if(outputs.begin(), outputs.end(), [&](const Resource& candidate) {
      return location_of(*producer.reflection, candidate) == location;
    });
    const bool is_block = type_of(consumer, input).base == spirv_cross::SPIRType::Struct;
    if (is_block || (output != outputs.end() && type_of(producer, *output) == type_of(consumer, input))) continue;
    // Arrays and matrices take the locations after their own as well.
    const bool may_be_within = std::any_of(outputs.begin(), outputs.end(), [&](const Resource& candidate) {
      return !takes_one_location(producer, candidate) && location_of(*producer.reflection, candidate) < location;
    });
    if (output == outputs.end() && may_be_within) continue;
    return fail(ErrorCode::compile, "compile.interface",
                fmt::format("the {} shader reads '{}' at location {}, which the {} shader {} (permutation '{}')",
                            to_string(consumer.stage), input.name, location, to_string(producer.stage),
                            output == outputs.end() ? "does not write" : "writes with another type", key));
  }
  return {};
}

}  // namespace

Status check_interfaces(std::span<const ShaderModule> modules, std::string_view permutation_key) {
  for (const ShaderModule& module : modules) {
    const ShaderModule* next = next_stage(modules, module);
    if (next == nullptr) continue;
    if (Status status = check_interface(module, *next, permutation_key); !status) return status;
  }
  return {};
}

std::vector<StageNeighbours> find_neighbours(std::span<const ShaderModule> modules) {
  std::vector<StageNeighbours> all(modules.size());
  for (std::size_t i = 0; i < modules.size(); ++i) {
    const ShaderModule* next = next_stage(modules, modules[i]);
    if (next == nullptr) continue;
    all[i].consumer = next->stage;
    all[i].unread_outputs = unread_outputs(modules[i], *next);
    all[static_cast<std::size_t>(next - modules.data())].producer = modules[i].stage;
  }
  return all;
}

void rename_varyings(Compiler& compiler, const ShaderModule& module, const StageNeighbours& neighbours) {
  if (neighbours.producer) {
    for (const Resource& input : module.resources.stage_inputs) rename(compiler, input, *neighbours.producer);
  }
  if (neighbours.consumer) {
    for (const Resource& output : module.resources.stage_outputs) rename(compiler, output, module.stage);
  }
}

spirv_cross::ParsedIR hide_unread_outputs(const ShaderModule& module, const StageNeighbours& neighbours) {
  spirv_cross::ParsedIR ir = *module.ir;
  for (const Resource& output : module.resources.stage_outputs) {
    if (neighbours.unread_outputs.count(location_of(*module.reflection, output)) == 0) continue;
    auto& variable = spirv_cross::variant_get<spirv_cross::SPIRVariable>(ir.ids[output.id]);
    variable.storage = spv::StorageClassPrivate;
  }
  return ir;
}

}  // namespace relievo
