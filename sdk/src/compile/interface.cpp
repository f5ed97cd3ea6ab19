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

}  // namespace

std::vector<StageNeighbours> find_neighbours(std::span<const ShaderModule> modules) {
  std::vector<StageNeighbours> all(modules.size());
  for (std::size_t i = 0; i < modules.size(); ++i) {
    const ShaderModule* next = nullptr;
    for (std::size_t k = 0; k < modules.size(); ++k) {
      if (modules[k].stage <= modules[i].stage) continue;
      if (next == nullptr || modules[k].stage < next->stage) next = &modules[k];
    }
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
  spirv_cross::ParsedIR ir = module.ir;
  for (const Resource& output : module.resources.stage_outputs) {
    if (neighbours.unread_outputs.count(location_of(*module.reflection, output)) == 0) continue;
    auto& variable = spirv_cross::variant_get<spirv_cross::SPIRVariable>(ir.ids[output.id]);
    variable.storage = spv::StorageClassPrivate;
  }
  return ir;
}

}  // namespace relievo
