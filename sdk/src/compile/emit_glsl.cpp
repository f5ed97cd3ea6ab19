#include <optional>
#include <set>
#include <spirv_cross/spirv_glsl.hpp>
#include <stdexcept>
#include <utility>

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

/// Whether this version spells out that arithmetic must stay as written.
bool has_precise(const CompilerGLSL::Options& options) {
  return options.es ? options.version >= 320 : options.version >= 400;
}

/// Whether this version chooses between vectors component by component with mix(); older ones read each component
/// apart.
bool has_boolean_mix(const CompilerGLSL::Options& options) {
  return options.version >= (options.es ? 310u : 450u);
}

/// Whether the shader has an OpSelect on vectors.
bool selects_vectors(const SpirvWords& words) {
  std::set<std::uint32_t> vectors;
  bool found = false;
  for_each_instruction(words, [&](const SpirvInstruction& instruction) {
    const std::uint32_t first = instruction.operands.empty() ? 0 : instruction.operands.front();
    if (instruction.opcode == spv::OpTypeVector) vectors.insert(first);
    if (instruction.opcode == spv::OpSelect) found = found || vectors.count(first) != 0;
  });
  return found;
}

/// One shader for one version after another. SPIRV-Cross analyses a module, then emits it again and again until it
/// knows every expression that needs a variable of its own. Neither depends on the version, and together they are most
/// of the work, so later versions go on from there.
class GlslTexts : public CompilerGLSL {
 public:
  using CompilerGLSL::CompilerGLSL;

  std::string emit(const Options& wanted) {
    set_common_options(wanted);
    return std::exchange(analysed_, true) ? emit_again() : compile();
  }

 private:
  /// What `CompilerGLSL::compile` does after its analyses.
  std::string emit_again() {
    backend.allow_precision_qualifiers = options.es;
    backend.requires_relaxed_precision_analysis = options.es;
    backend.support_precise_qualifier = has_precise(options);
    forced_extensions.clear();
    find_static_extensions();
    std::uint32_t passes = 0;
    do {
      reset(passes++);
      buffer.reset();
      emit_header();
      emit_resources();
      emit_extension_workarounds(get_execution_model());
      emit_function(get<spirv_cross::SPIRFunction>(ir.default_entry_point), {});
    } while (is_forcing_recompilation());
    return buffer.str();
  }

  bool analysed_ = false;
};

void prepare(CompilerGLSL& compiler, const ShaderModule& module, const BindingLayout& layout,
             const StageNeighbours& neighbours) {
  compiler.set_enabled_interface_variables(compiler.get_active_interface_variables());
  bind_all(compiler, module, layout);
  rename_varyings(compiler, module, neighbours);
}

}  // namespace

void emit_glsl(std::span<const Target> targets, const ShaderModule& module, const BindingLayout& layout,
               const StageNeighbours& neighbours, const TextSink& sink) {
  const bool mixes = selects_vectors(module.spirv);
  std::optional<GlslTexts> compiler;
  bool was_mixing = false;
  for (const Target& target : targets) {
    const CompilerGLSL::Options options = options_for(target);
    const bool is_mixing = mixes && has_boolean_mix(options);
    // Which expressions need a variable depends on it.
    if (!compiler || is_mixing != was_mixing) prepare(compiler.emplace(module.ir), module, layout, neighbours);
    was_mixing = is_mixing;
    std::string text = compiler->emit(options);
    check_names(*compiler, module);
    sink(std::move(text));
  }
}

}  // namespace relievo
