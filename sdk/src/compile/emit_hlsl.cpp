#include <algorithm>
#include <spirv_cross/spirv_hlsl.hpp>
#include <string_view>

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

/// Returns the buffer that gl_NumWorkGroups becomes, or 0 where it is unused.
spirv_cross::VariableID bind_workgroup_count(CompilerHLSL& compiler, spv::ExecutionModel stage,
                                             const BindingLayout& layout) {
  const spirv_cross::VariableID id = compiler.remap_num_workgroups_builtin();
  if (id == spirv_cross::VariableID(0)) return id;
  HlslRegisters registers;
  registers.b = layout.hlsl_workgroup_count;
  compiler.set_decoration(id, spv::DecorationDescriptorSet, kWorkgroupCountSet);
  compiler.set_decoration(id, spv::DecorationBinding, 0);
  compiler.add_hlsl_resource_binding(binding_for(stage, kWorkgroupCountSet, 0, registers));
  return id;
}

/// An image that another shader writes keeps its u register here too, even where this shader only reads it.
void keep_written_images_writable(CompilerHLSL& compiler, const ShaderModule& module, const BindingLayout& layout) {
  for (const spirv_cross::Resource& image : module.resources.storage_images) {
    const auto set = compiler.get_decoration(image.id, spv::DecorationDescriptorSet);
    const auto binding = compiler.get_decoration(image.id, spv::DecorationBinding);
    const BoundResource* entry = layout.find(static_cast<int>(set), static_cast<int>(binding));
    if (!entry->read_only) compiler.unset_decoration(image.id, spv::DecorationNonWritable);
  }
}

CompilerHLSL::Options options_for(const Target& target) {
  CompilerHLSL::Options options;
  options.shader_model = static_cast<std::uint32_t>(target.version);
  options.support_nonzero_base_vertex_base_instance = false;
  options.point_size_compat = true;
  options.nonwritable_uav_texture_as_srv = true;  // shader model 5.0 cannot load vectors from a u register
  return options;
}

std::string emit_text(const Target& target, const ShaderModule& module, const BindingLayout& layout,
                      const StageNeighbours& neighbours) {
  CompilerHLSL compiler(hide_unread_outputs(module, neighbours));
  compiler.set_hlsl_options(options_for(target));
  const spv::ExecutionModel stage = module.execution_model();
  bind_all(compiler, stage, layout);
  keep_written_images_writable(compiler, module, layout);
  auto active = compiler.get_active_interface_variables();
  active.insert(bind_workgroup_count(compiler, stage, layout));
  compiler.set_enabled_interface_variables(std::move(active));
  return compiler.compile();
}

/// The first version that names the space of each register.
constexpr int kNamesSpaces = 51;

/// Makes the text of shader model 5.0 one of 5.1 or later: " : register(b0)" becomes " : register(b0, space0)".
/// Declarations start at the margin; inside a function the same letters could be an expression.
std::string name_spaces(std::string_view text) {
  std::string named;
  named.reserve(text.size() + text.size() / 16);
  while (!text.empty()) {
    const std::string_view line = text.substr(0, std::min(text.find('\n'), text.size() - 1) + 1);
    const std::size_t start = line.starts_with(' ') ? std::string_view::npos : line.find(" : register(");
    const std::size_t end = start == std::string_view::npos ? 0 : line.find(')', start);
    named += line.substr(0, end);
    if (end != 0) named += ", space0";
    named += line.substr(end);
    text.remove_prefix(line.size());
  }
  return named;
}

}  // namespace

/// From 5.0 to 6.0, SPIRV-Cross asks for the shader model only to refuse what an old one lacks and to name spaces: the
/// oldest is emitted, the others are made of its text.
void emit_hlsl(std::span<const Target> targets, const ShaderModule& module, const BindingLayout& layout,
               const StageNeighbours& neighbours, const TextSink& sink) {
  const Target& oldest = targets.front();
  std::string text = emit_text(oldest, module, layout, neighbours);
  const bool is_named = oldest.version >= kNamesSpaces;
  for (const Target& target : targets) {
    sink(is_named || target.version < kNamesSpaces ? text : name_spaces(text));
  }
}

}  // namespace relievo
