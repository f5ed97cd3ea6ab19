#include "relievo/compile.hpp"

#include <fmt/format.h>

#include <optional>
#include <set>

#include "compile/bindings.hpp"
#include "compile/capabilities.hpp"
#include "compile/emit.hpp"
#include "compile/front_end.hpp"
#include "compile/interface.hpp"
#include "compile/lint.hpp"
#include "compile/optimize.hpp"
#include "compile/parallel.hpp"
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

/// Validates what ships; when that fails, the front end's words say whose fault it is.
Status validate_pipeline(const SpirvWords& before, const SpirvWords& after, std::string_view key) {
  Status shipped = validate_spirv(after, key, "after the optimizer");
  if (shipped) return {};
  if (Status ok = validate_spirv(before, key, "after the front end"); !ok) return ok;
  return shipped;
}

/// One shader from the front end's SPIR-V to what ships: linted, optimized, validated, parsed.
Result<ShaderModule> finish_module(ShaderStage stage, const SpirvWords& front_end_words, const CompileOptions& options,
                                   std::string_view key) {
  if (auto ok = lint_implicit_lod_in_loop(front_end_words, key); !ok) return tl::unexpected(ok.error());
  SpirvWords plain = strip_lines(front_end_words);
  Result<SpirvWords> words = options.optimize ? optimize_spirv(plain, key) : Result<SpirvWords>(plain);
  if (!words) return tl::unexpected(words.error());
  if (options.validate) {
    if (auto ok = validate_pipeline(plain, *words, key); !ok) return tl::unexpected(ok.error());
  }
  return parse_module(stage, *std::move(words), key);
}

Result<std::vector<ShaderModule>> make_modules(const ComposedProgram& program, const CompileOptions& options) {
  Result<std::vector<SpirvWords>> front_end = run_front_end(program);
  if (!front_end) return tl::unexpected(front_end.error());
  std::vector<std::optional<Result<ShaderModule>>> results(program.shaders.size());
  run_parallel(results.size(), options.threads, [&](std::size_t i) {
    results[i] = finish_module(program.shaders[i].stage, (*front_end)[i], options, program.key);
  });
  std::vector<ShaderModule> modules;
  for (auto& result : results) {
    if (!*result) return tl::unexpected(result->error());
    modules.push_back(*std::move(*result));
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

/// Every shader for every family of targets; tasks are independent and each compiles a copy of its module.
Status emit_all(std::span<const Target> targets, std::span<const ShaderModule> modules, const BindingLayout& layout,
                const CompileOptions& options, CompiledProgram& compiled) {
  const std::vector<TargetFamily> families = group_targets(targets);
  const std::vector<StageNeighbours> neighbours = find_neighbours(modules);
  std::vector<std::optional<Result<std::vector<std::string>>>> results(modules.size() * families.size());
  run_parallel(results.size(), options.threads, [&](std::size_t task) {
    const std::size_t i = task / families.size();
    results[task] = emit_family(families[task % families.size()], modules[i], layout, neighbours[i], compiled.key);
  });
  for (std::size_t i = 0; i < modules.size(); ++i) {
    CompiledShader shader{modules[i].stage, modules[i].spirv, {}};
    for (std::size_t f = 0; f < families.size(); ++f) {
      Result<std::vector<std::string>>& texts = *results[i * families.size() + f];
      if (!texts) return tl::unexpected(texts.error());
      for (std::size_t k = 0; k < texts->size(); ++k) shader.text[to_string(families[f][k])] = std::move((*texts)[k]);
    }
    compiled.shaders.push_back(std::move(shader));
  }
  return {};
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
  if (auto ok = emit_all(targets, *modules, *layout, options, compiled); !ok) return tl::unexpected(ok.error());
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
