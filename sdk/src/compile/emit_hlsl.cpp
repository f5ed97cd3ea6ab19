#include <spirv_cross/spirv_hlsl.hpp>

#include "compile/emit_targets.hpp"

namespace relievo {

namespace {

using spirv_cross::CompilerHLSL;
using spirv_cross::HLSLResourceBinding;

// gl_NumWorkGroups becomes a buffer without an author's place; this one collides with none.
constexpr std::uint32_t kWorkgroupCountSet = 0x7ffffff0u;

HLSLResourceBinding binding_for(spv::ExecutionModel stage, std::uint32_t set, std::uint32_t binding,
                                const HlslRegisters& registers) {
  HLSLResourceBinding result;
  result.stage = stage;
  result.desc_set = set;
  result.binding = binding;
  const auto put = [](HLSLResourceBinding::Binding& target, int number) {
    if (number != kNoSlot) target.register_binding = static_cast<std::uint32_t>(number);
  };
  put(result.cbv, registers.b);
  put(result.srv, registers.t);
  put(result.sampler, registers.s);
  put(result.uav, registers.u);
  return result;
}

void bind_all(CompilerHLSL& compiler, spv::ExecutionModel stage, const BindingLayout& layout) {
  for (const BoundResource& entry : layout.resources) {
    const auto set = static_cast<std::uint32_t>(entry.slot.set);
    const auto binding = static_cast<std::uint32_t>(entry.slot.binding);
    compiler.add_hlsl_resource_binding(binding_for(stage, set, binding, entry.hlsl));
    // Read-only here but written by another shader: one register must serve both.
    if (!entry.read_only) compiler.set_hlsl_force_storage_buffer_as_uav(set, binding);
  }
  if (layout.push_constants) {
    compiler.add_hlsl_resource_binding(binding_for(stage, spirv_cross::ResourceBindingPushConstantDescriptorSet,
                                                   spirv_cross::ResourceBindingPushConstantBinding,
                                                   layout.push_constants->hlsl));
  }
}

void bind_workgroup_count(CompilerHLSL& compiler, spv::ExecutionModel stage, const BindingLayout& layout) {
  const spirv_cross::VariableID id = compiler.remap_num_workgroups_builtin();
  if (id == spirv_cross::VariableID(0)) return;
  HlslRegisters registers;
  registers.b = layout.hlsl_workgroup_count;
  compiler.set_decoration(id, spv::DecorationDescriptorSet, kWorkgroupCountSet);
  compiler.set_decoration(id, spv::DecorationBinding, 0);
  compiler.add_hlsl_resource_binding(binding_for(stage, kWorkgroupCountSet, 0, registers));
}

CompilerHLSL::Options options_for(const Target& target) {
  CompilerHLSL::Options options;
  options.shader_model = static_cast<std::uint32_t>(target.version);
  options.support_nonzero_base_vertex_base_instance = false;
  options.point_size_compat = true;
  return options;
}

}  // namespace

std::string emit_hlsl(const Target& target, const ShaderModule& module, const BindingLayout& layout,
                      const StageNeighbours& neighbours) {
  CompilerHLSL compiler(module.ir);
  compiler.set_hlsl_options(options_for(target));
  const spv::ExecutionModel stage = module.execution_model();
  bind_all(compiler, stage, layout);
  bind_workgroup_count(compiler, stage, layout);
  compiler.set_enabled_interface_variables(compiler.get_active_interface_variables());
  // Direct3D links by position in the signature: both sides must list the same varyings.
  for (const int location : neighbours.unread_outputs) {
    compiler.mask_stage_output_by_location(static_cast<std::uint32_t>(location), 0);
  }
  return compiler.compile();
}

}  // namespace relievo
