#include "relievo/compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compile/bindings.hpp"
#include "compile/capabilities.hpp"
#include "compile/emit.hpp"
#include "compile/front_end.hpp"
#include "compile/interface.hpp"
#include "compile/lint.hpp"
#include "compile/optimize.hpp"
#include "compile/reflection.hpp"

namespace relievo {

namespace {

Status check_request(const ComposedProgram& program, std::span<const Target> targets, std::string_view fallback_stage) {
  std::set<ShaderStage> stages;
  for (const ComposedShader& shader : program.shaders) {
    if (stages.insert(shader.stage).second) continue;
    return fail(ErrorCode::compile, "compile.shaders",
                fmt::format("permutation '{}' has two {} shaders, expected one", program.key, to_string(shader.stage)));
  }
  if (stages.empty()) {
    return fail(ErrorCode::compile, "compile.shaders",
                fmt::format("permutation '{}' has no shaders, expected at least one", program.key));
  }
  for (const Target& target : targets) {
    if (auto parsed = parse_target(to_string(target)); !parsed) return tl::unexpected(parsed.error());
    if (auto ok = check_capabilities(target, program, fallback_stage); !ok) return ok;
  }
  return {};
}

/// One shader from the front end's SPIR-V to what ships: linted, validated, optimized.
Result<SpirvWords> finish_spirv(const SpirvWords& front_end_words, const CompileOptions& options,
                                std::string_view key) {
  if (auto ok = lint_implicit_lod_in_loop(front_end_words, key); !ok) return tl::unexpected(ok.error());
  SpirvWords words = strip_lines(front_end_words);
  if (options.validate) {
    if (auto ok = validate_spirv(words, key, "after the front end"); !ok) return tl::unexpected(ok.error());
  }
  if (!options.optimize) return words;
  Result<SpirvWords> optimized = optimize_spirv(words, key);
  if (optimized && options.validate) {
    if (auto ok = validate_spirv(*optimized, key, "after the optimizer"); !ok) return tl::unexpected(ok.error());
  }
  return optimized;
}

Result<std::vector<ShaderModule>> make_modules(const ComposedProgram& program, const CompileOptions& options) {
  Result<std::vector<SpirvWords>> front_end = run_front_end(program);
  if (!front_end) return tl::unexpected(front_end.error());
  std::vector<ShaderModule> modules;
  for (std::size_t i = 0; i < program.shaders.size(); ++i) {
    Result<SpirvWords> words = finish_spirv((*front_end)[i], options, program.key);
    if (!words) return tl::unexpected(words.error());
    Result<ShaderModule> module = parse_module(program.shaders[i].stage, *std::move(words), program.key);
    if (!module) return tl::unexpected(module.error());
    modules.push_back(*std::move(module));
  }
  return modules;
}

Status check_modules(std::span<const ShaderModule> modules, const ComposedProgram& program,
                     std::span<const Target> targets, std::string_view fallback_stage) {
  for (const Target& target : targets) {
    for (const ShaderModule& module : modules) {
      if (auto ok = check_module_capabilities(target, module, program, fallback_stage); !ok) return ok;
    }
  }
  return {};
}

Result<std::map<std::string, std::string>> emit_all(std::span<const Target> targets, const ShaderModule& module,
                                                    const BindingLayout& layout, const StageNeighbours& neighbours,
                                                    std::string_view key) {
  std::map<std::string, std::string> texts;
  for (const Target& target : targets) {
    if (target.language == Language::spirv) continue;
    Result<std::string> text = emit_target(target, module, layout, neighbours, key);
    if (!text) return tl::unexpected(text.error());
    texts[to_string(target)] = *std::move(text);
  }
  return texts;
}

Result<CompiledProgram> run_pipeline(const ComposedProgram& program, std::span<const Target> targets,
                                     const CompileOptions& options, std::string_view fallback_stage) {
  if (auto ok = check_request(program, targets, fallback_stage); !ok) return tl::unexpected(ok.error());
  Result<std::vector<ShaderModule>> modules = make_modules(program, options);
  if (!modules) return tl::unexpected(modules.error());
  if (auto ok = check_modules(*modules, program, targets, fallback_stage); !ok) return tl::unexpected(ok.error());
  Result<BindingLayout> layout = make_binding_layout(*modules, program.key);
  if (!layout) return tl::unexpected(layout.error());

  CompiledProgram compiled;
  compiled.key = program.key;
  const std::vector<StageNeighbours> neighbours = find_neighbours(*modules);
  for (std::size_t i = 0; i < modules->size(); ++i) {
    auto texts = emit_all(targets, (*modules)[i], *layout, neighbours[i], program.key);
    if (!texts) return tl::unexpected(texts.error());
    compiled.shaders.push_back({(*modules)[i].stage, (*modules)[i].spirv, *std::move(texts)});
  }
  for (const BoundResource& resource : layout->resources) compiled.bindings.push_back(resource.slot);
  Result<std::string> reflection = make_reflection(program, *modules, *layout, targets);
  if (!reflection) return tl::unexpected(reflection.error());
  compiled.reflection = *std::move(reflection);
  return compiled;
}

}  // namespace

Result<CompiledProgram> compile(const ComposedProgram& program, std::span<const Target> targets,
                                const CompileOptions& options, std::string_view fallback_stage) {
  try {
    return run_pipeline(program, targets, options, fallback_stage);
  } catch (const std::exception& error) {  // nothing throws across the API, out of memory included
    return fail(ErrorCode::compile, "compile.internal",
                fmt::format("While compiling permutation '{}': {}", program.key, error.what()));
  }
}

}  // namespace relievo
