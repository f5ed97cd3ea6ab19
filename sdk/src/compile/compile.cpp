#include "relievo/compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <set>

#include "compile/bindings.hpp"
#include "compile/capabilities.hpp"
#include "compile/emit.hpp"
#include "compile/emit_program.hpp"
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

/// Validates what ships; when that fails, the front end's words say whose fault it is.
Status validate_pipeline(const SpirvWords& before, const SpirvWords& after, std::string_view key) {
  Status shipped = validate_spirv(after, key, "after the optimizer");
  if (shipped) return {};
  if (Status ok = validate_spirv(before, key, "after the front end"); !ok) return ok;
  return shipped;
}

/// One shader from the front end's SPIR-V to what ships: linted, optimized.
Result<SpirvWords> finish_words(const SpirvWords& front_end_words, const CompileOptions& options,
                                std::string_view key) {
  if (auto ok = lint_implicit_lod_in_loop(front_end_words, key); !ok) return tl::unexpected(ok.error());
  SpirvWords plain = strip_lines(front_end_words);
  return options.optimize ? optimize_spirv(plain, key) : Result<SpirvWords>(std::move(plain));
}

/// What cannot be read is explained best by what is wrong with it.
Result<ShaderModule> parse_shipped(ShaderStage stage, SpirvWords words, const SpirvWords& before,
                                   const CompileOptions& options, std::string_view key) {
  const auto shared = std::make_shared<const SpirvWords>(std::move(words));
  Result<ShaderModule> module = parse_module(stage, shared, key);
  if (module || !options.validate) return module;
  if (auto ok = validate_pipeline(before, *shared, key); !ok) return tl::unexpected(ok.error());
  return module;
}

Result<std::vector<ShaderModule>> make_modules(const ComposedProgram& program,
                                               std::span<const SpirvWords> front_end_words,
                                               const CompileOptions& options, Crew& crew) {
  std::vector<std::optional<Result<ShaderModule>>> results(program.shaders.size());
  const auto size_of = [&](std::size_t i) { return front_end_words[i].size(); };
  crew.run(largest_first(results.size(), size_of), [&](std::size_t i) {
    Result<SpirvWords> words = finish_words(front_end_words[i], options, program.key);
    results[i] =
        words ? parse_shipped(program.shaders[i].stage, *std::move(words), front_end_words[i], options, program.key)
              : Result<ShaderModule>(tl::unexpected(words.error()));
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

/// What is made of the modules of a program; every part by a task of its own.
struct Outputs {
  explicit Outputs(std::size_t modules) : valid(modules), texts(modules) {}

  std::vector<Status> valid;                                         ///< one a module
  std::vector<std::vector<Result<std::vector<std::string>>>> texts;  ///< by module and family
  Result<std::string> reflection;
};

/// Emits beside validating: the optimizer has trusted the front end's words before.
Outputs make_outputs(const ComposedProgram& program, const EmitContext& context, std::span<const ShaderModule> modules,
                     const BindingLayout& layout, std::span<const Target> targets, bool validate, Crew& crew) {
  const std::vector<TargetFamily> families = group_targets(targets);
  const std::vector<StageNeighbours> neighbours = find_neighbours(modules);
  Outputs outputs(modules.size());
  std::vector<std::function<void()>> tasks;
  const auto size_of = [&](std::size_t i) { return modules[i].spirv->size(); };
  for (const std::size_t i : largest_first(modules.size(), size_of)) {
    outputs.texts[i].resize(families.size());
    for (std::size_t f = 0; f < families.size(); ++f) {
      tasks.emplace_back([&, i, f] {
        const auto emit = [&] { return emit_family(families[f], modules[i], layout, neighbours[i], program.key); };
        outputs.texts[i][f] =
            context.memo ? context.memo->texts(families[f], modules[i], layout, neighbours[i], emit) : emit();
      });
    }
    if (!validate) continue;
    tasks.emplace_back(
        [&, i] { outputs.valid[i] = validate_pipeline(context.front_end_words[i], *modules[i].spirv, program.key); });
  }
  tasks.emplace_back([&] { outputs.reflection = make_reflection(program, modules, layout, targets); });
  crew.run(tasks.size(), [&](std::size_t task) { tasks[task](); });
  return outputs;
}

/// The first thing that went wrong; an invalid module before what was made of it.
Status check_outputs(const Outputs& outputs) {
  for (const Status& valid : outputs.valid) {
    if (!valid) return valid;
  }
  for (const auto& families : outputs.texts) {
    for (const auto& texts : families) {
      if (!texts) return tl::unexpected(texts.error());
    }
  }
  if (!outputs.reflection) return tl::unexpected(outputs.reflection.error());
  return {};
}

CompiledProgram collect(const ComposedProgram& program, std::span<const Target> targets, const BindingLayout& layout,
                        std::span<const ShaderModule> modules, Outputs outputs) {
  const std::vector<TargetFamily> families = group_targets(targets);
  CompiledProgram compiled;
  compiled.key = program.key;
  for (std::size_t i = 0; i < modules.size(); ++i) {
    CompiledShader& shader = compiled.shaders.emplace_back();
    shader.stage = modules[i].stage;
    shader.spirv = *modules[i].spirv;
    for (std::size_t f = 0; f < families.size(); ++f) {
      for (std::size_t k = 0; k < families[f].size(); ++k) {
        shader.text[to_string(families[f][k])] = std::move((*outputs.texts[i][f])[k]);
      }
    }
  }
  for (const BoundResource& resource : layout.resources) compiled.bindings.push_back(resource.slot);
  compiled.reflection = *std::move(outputs.reflection);
  return compiled;
}

Result<CompiledProgram> run_pipeline(const ComposedProgram& program, std::span<const Target> targets,
                                     const CompileOptions& options, std::string_view fallback_stage) {
  if (auto ok = check_request(program, targets, fallback_stage); !ok) return tl::unexpected(ok.error());
  Crew crew(options.threads);
  Result<std::vector<SpirvWords>> front_end_words = run_front_end(program, crew);
  if (!front_end_words) return tl::unexpected(front_end_words.error());
  const Result<std::vector<ShaderModule>> modules = make_modules(program, *front_end_words, options, crew);
  if (!modules) return tl::unexpected(modules.error());
  return emit_program(program, *modules, targets, options, fallback_stage, {*front_end_words, nullptr}, crew);
}

}  // namespace

Result<CompiledProgram> emit_program(const ComposedProgram& program, std::span<const ShaderModule> modules,
                                     std::span<const Target> targets, const CompileOptions& options,
                                     std::string_view fallback_stage, const EmitContext& context, Crew& crew) {
  if (auto ok = check_modules(modules, program, targets, fallback_stage); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_interfaces(modules, program.key); !ok) return tl::unexpected(ok.error());
  Result<BindingLayout> layout = make_binding_layout(modules, program.key);
  if (!layout) return tl::unexpected(layout.error());
  Outputs outputs = make_outputs(program, context, modules, *layout, targets, options.validate, crew);
  if (auto ok = check_outputs(outputs); !ok) return tl::unexpected(ok.error());
  return collect(program, targets, *layout, modules, std::move(outputs));
}

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
