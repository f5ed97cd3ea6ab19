#include <algorithm>
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

/// Whether this version spells out that arithmetic must stay as written. GLSL 330 could by GL_ARB_gpu_shader5, but
/// glslang does not know the word there.
bool has_precise(const CompilerGLSL::Options& options) {
  return options.version >= (options.es ? 310u : 400u);
}

/// Of the versions that have it.
bool has_precise_by_extension(const CompilerGLSL::Options& options) {
  return options.es && options.version < 320;
}

bool uses_precise(const ShaderModule& module) {
  bool found = false;
  for_each_instruction(*module.spirv, [&](const SpirvInstruction& instruction) {
    found = found || (instruction.opcode == spv::OpDecorate &&
                      instruction.operands[1] == static_cast<std::uint32_t>(spv::DecorationNoContraction));
  });
  return found;
}

/// Whether this version chooses between vectors component by component with mix(); older ones read each component
/// apart.
bool has_boolean_mix(const CompilerGLSL::Options& options) {
  return options.version >= (options.es ? 310u : 450u);
}

/// What a shader has that SPIRV-Cross writes differently in one version than in the next of the same profile, apart
/// from what needs an extension in the older one.
struct VersionDependence {
  bool selects_vectors = false;  ///< OpSelect on vectors, see has_boolean_mix
  bool has_hints = false;        ///< to unroll or to flatten; unknown to ESSL 300
  bool passes_structs = false;   ///< between stages, blocks too; ESSL 300 takes them apart

  bool any() const { return selects_vectors || has_hints || passes_structs; }
};

bool passes_structs(const ShaderModule& module) {
  const auto is_struct = [&](const Resource& varying) {
    return module.reflection->get_type(varying.base_type_id).basetype == spirv_cross::SPIRType::Struct;
  };
  const auto& resources = module.resources;
  return std::any_of(resources.stage_inputs.begin(), resources.stage_inputs.end(), is_struct) ||
         std::any_of(resources.stage_outputs.begin(), resources.stage_outputs.end(), is_struct);
}

VersionDependence find_version_dependence(const ShaderModule& module) {
  VersionDependence found;
  found.passes_structs = passes_structs(module);
  std::set<std::uint32_t> vectors;
  for_each_instruction(*module.spirv, [&](const SpirvInstruction& instruction) {
    const auto& operands = instruction.operands;
    switch (instruction.opcode) {
      case spv::OpTypeVector:
        vectors.insert(operands[0]);
        break;
      case spv::OpSelect:
        found.selects_vectors = found.selects_vectors || vectors.count(operands[0]) != 0;
        break;
      case spv::OpSelectionMerge:
        found.has_hints = found.has_hints || operands[1] != 0;
        break;
      case spv::OpLoopMerge:
        found.has_hints = found.has_hints || operands[2] != 0;
        break;
      default:
        break;
    }
  });
  return found;
}

/// One shader for one version after another. SPIRV-Cross analyses a module, then emits it again and again until it
/// knows every expression that needs a variable of its own. Neither depends on the version, and together they are most
/// of the work, so later versions go on from there; and where the functions read alike, only what is around them is
/// emitted.
class GlslTexts : public CompilerGLSL {
 public:
  GlslTexts(const spirv_cross::ParsedIR& parsed, bool uses_precise)
      : CompilerGLSL(parsed), uses_precise_(uses_precise) {}

  /// `keep_functions`: they read as in the version before, if that one needed no extension.
  std::string emit(const Options& wanted, bool keep_functions) {
    keeps_functions_ = keep_functions && forced_extensions.empty();
    set_common_options(wanted);
    std::string text = std::exchange(analysed_, true) ? emit_again() : compile();
    if (keeps_functions_) return text + functions_;
    functions_ = text.substr(functions_start_);
    return text;
  }

 private:
  /// What `CompilerGLSL::compile` does after its analyses.
  std::string emit_again() {
    backend.allow_precision_qualifiers = options.es;
    backend.requires_relaxed_precision_analysis = options.es;
    if (std::exchange(backend.support_precise_qualifier, has_precise(options)) != has_precise(options)) {
      forced_temporaries.clear();  // `precise` needs variables of its own, and spares others
    }
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

  /// Drivers without the extension compile what is `precise` as they compile the rest.
  void add_extension_of_precise() {
    header_lines.clear();
    if (!uses_precise_ || !has_precise(options) || !has_precise_by_extension(options)) return;
    for (const char* line :
         {"#ifdef GL_EXT_gpu_shader5", "#extension GL_EXT_gpu_shader5 : enable", "#else", "#define precise", "#endif"})
      header_lines.push_back(line);
  }

  void emit_header() override {
    backend.support_precise_qualifier = has_precise(options);
    add_extension_of_precise();
    CompilerGLSL::emit_header();
    functions_start_ = 0;
    if (!keeps_functions_) return;
    // Functions that are "active" have been emitted.
    ir.for_each_typed_id<spirv_cross::SPIRFunction>(
        [](std::uint32_t, spirv_cross::SPIRFunction& function) { function.active = true; });
  }

  void emit_function_prototype(spirv_cross::SPIRFunction& function, const spirv_cross::Bitset& flags) override {
    if (functions_start_ == 0) functions_start_ = buffer.str().size();
    CompilerGLSL::emit_function_prototype(function, flags);
  }

  bool uses_precise_;
  bool analysed_ = false;
  bool keeps_functions_ = false;
  std::string functions_;  ///< of the version before
  std::size_t functions_start_ = 0;
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
  const VersionDependence depends = find_version_dependence(module);
  std::optional<GlslTexts> compiler;
  CompilerGLSL::Options before;
  for (const Target& target : targets) {
    const CompilerGLSL::Options options = options_for(target);
    // Which expressions need a variable depends on how vectors are chosen; and a struct taken apart stays so.
    const bool chooses_otherwise = depends.selects_vectors && has_boolean_mix(options) != has_boolean_mix(before);
    const bool is_new = !compiler || chooses_otherwise || depends.passes_structs;
    if (is_new) prepare(compiler.emplace(*module.ir, uses_precise(module)), module, layout, neighbours);
    const bool reads_alike = options.es == before.es && has_precise(options) == has_precise(before);
    std::string text = compiler->emit(options, !is_new && reads_alike && !depends.any());
    before = options;
    check_names(*compiler, module);
    sink(std::move(text));
  }
}

}  // namespace relievo
