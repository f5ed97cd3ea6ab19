#include <spirv_cross/spirv_msl.hpp>

#include "compile/emit_targets.hpp"

namespace relievo {

namespace {

using spirv_cross::CompilerMSL;
using spirv_cross::MSLResourceBinding;

MSLResourceBinding binding_for(spv::ExecutionModel stage, std::uint32_t set, std::uint32_t binding,
                               const MslIndices& indices) {
  MSLResourceBinding result;
  result.stage = stage;
  result.desc_set = set;
  result.binding = binding;
  if (indices.buffer != kNoSlot) result.msl_buffer = static_cast<std::uint32_t>(indices.buffer);
  if (indices.texture != kNoSlot) result.msl_texture = static_cast<std::uint32_t>(indices.texture);
  if (indices.sampler != kNoSlot) result.msl_sampler = static_cast<std::uint32_t>(indices.sampler);
  return result;
}

void bind_all(CompilerMSL& compiler, spv::ExecutionModel stage, const BindingLayout& layout) {
  for (const BoundResource& entry : layout.resources) {
    compiler.add_msl_resource_binding(binding_for(stage, static_cast<std::uint32_t>(entry.slot.set),
                                                  static_cast<std::uint32_t>(entry.slot.binding), entry.msl));
  }
  if (layout.push_constants) {
    compiler.add_msl_resource_binding(binding_for(stage, spirv_cross::ResourceBindingPushConstantDescriptorSet,
                                                  spirv_cross::ResourceBindingPushConstantBinding,
                                                  layout.push_constants->msl));
  }
}

CompilerMSL::Options options_for(const Target& target) {
  CompilerMSL::Options options;
  options.platform = CompilerMSL::Options::macOS;
  options.set_msl_version(static_cast<std::uint32_t>(target.version / 10),
                          static_cast<std::uint32_t>(target.version % 10));
  options.buffer_size_buffer_index = kMslBufferSizes;
  return options;
}

}  // namespace

void emit_msl(std::span<const Target> targets, const ShaderModule& module, const BindingLayout& layout,
              const StageNeighbours& neighbours, const TextSink& sink) {
  for (const Target& target : targets) {
    CompilerMSL compiler(hide_unread_outputs(module, neighbours));
    compiler.set_msl_options(options_for(target));
    bind_all(compiler, module.execution_model(), layout);
    compiler.set_enabled_interface_variables(compiler.get_active_interface_variables());
    sink(compiler.compile());
  }
}

}  // namespace relievo
