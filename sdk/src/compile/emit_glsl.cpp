#include <spirv_cross/spirv_glsl.hpp>
#include <stdexcept>

#include "compile/emit_targets.hpp"

namespace relievo {

namespace {

using spirv_cross::CompilerGLSL;
using spirv_cross::Resource;

CompilerGLSL::Options options_for(const Target& target) {
  CompilerGLSL::Options options;
  options.version = static_cast<std::uint32_t>(target.version);
  options.es = target.language == Language::essl;
  options.vulkan_semantics = false;
  options.separate_shader_objects = false;
  options.enable_420pack_extension = false;  // GLSL 330 binds by name
  options.emit_push_constant_as_uniform_buffer = true;
  options.force_zero_initialized_variables = true;  // what the optimizer leaves undefined, drivers warn of
  options.vertex.fixup_clipspace = false;
  options.vertex.flip_vert_y = false;
  options.vertex.support_nonzero_base_instance = false;  // else a uniform appears that nobody sets
  options.fragment.default_float_precision = CompilerGLSL::Options::Highp;
  options.fragment.default_int_precision = CompilerGLSL::Options::Highp;
  return options;
}

void bind(CompilerGLSL& compiler, spirv_cross::ID id, int slot) {
  compiler.unset_decoration(id, spv::DecorationDescriptorSet);
  compiler.set_decoration(id, spv::DecorationBinding, static_cast<std::uint32_t>(slot));
}

/// Puts every resource of the shader at its flat slot.
void bind_all(CompilerGLSL& compiler, const ShaderModule& module, const BindingLayout& layout) {
  const auto& resources = module.resources;
  for (const auto* list :
       {&resources.uniform_buffers, &resources.storage_buffers, &resources.sampled_images, &resources.storage_images}) {
    for (const Resource& resource : *list) {
      const auto set = module.reflection->get_decoration(resource.id, spv::DecorationDescriptorSet);
      const auto binding = module.reflection->get_decoration(resource.id, spv::DecorationBinding);
      const BoundResource* entry = layout.find(static_cast<int>(set), static_cast<int>(binding));
      bind(compiler, resource.id, entry->slot.gl_slot);
    }
  }
  for (const Resource& push : resources.push_constant_buffers) bind(compiler, push.id, layout.push_constants->gl_slot);
}

/// Runtimes bind by name where layout(binding) is missing, so SPIRV-Cross must not have renamed anything.
void check_names(const CompilerGLSL& compiler, const ShaderModule& module) {
  const auto expect = [](const std::string& given, const std::string& expected) {
    if (given != expected) throw std::runtime_error("'" + expected + "' is emitted as '" + given + "'; rename it");
  };
  const auto& resources = module.resources;
  for (const auto* list : {&resources.uniform_buffers, &resources.storage_buffers}) {
    for (const Resource& block : *list) expect(compiler.get_remapped_declared_block_name(block.id), block.name);
  }
  for (const auto* list : {&resources.sampled_images, &resources.storage_images}) {
    for (const Resource& texture : *list) expect(compiler.get_name(texture.id), texture.name);
  }
}

}  // namespace

std::string emit_glsl(const Target& target, const ShaderModule& module, const BindingLayout& layout,
                      const StageNeighbours& neighbours) {
  CompilerGLSL compiler(module.ir);
  compiler.set_common_options(options_for(target));
  compiler.set_enabled_interface_variables(compiler.get_active_interface_variables());
  bind_all(compiler, module, layout);
  rename_varyings(compiler, module, neighbours);
  std::string text = compiler.compile();
  check_names(compiler, module);
  return text;
}

}  // namespace relievo
