#include "permute/compile_closures.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>

#include "compile/emit_program.hpp"
#include "compile/front_end.hpp"
#include "compile/lint.hpp"
#include "compile/optimize.hpp"
#include "compile/parallel.hpp"
#include "permute/cost.hpp"

#include "relievo/permute.hpp"

namespace relievo {

namespace {

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::string_view bytes_of(const SpirvWords& words) {
  return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(words[0])};
}

CacheKey source_key(const ComposedShader& shader) {
  return cache_key({to_string(shader.stage), shader.text});
}

/// One shader alone: whether it fits its neighbours is checked on the SPIR-V.
Result<SpirvWords> front_end(const ComposedShader& shader, const std::string& name) {
  ComposedProgram alone;
  alone.key = name;
  alone.shaders = {shader};
  Crew this_thread(1);
  const Result<std::vector<SpirvWords>> words = run_front_end(alone, this_thread);
  if (!words) return tl::unexpected(words.error());
  if (Status ok = lint_implicit_lod_in_loop(words->front(), name); !ok) return tl::unexpected(ok.error());
  return strip_lines(words->front());
}

Result<SpirvWords> ship(const SpirvWords& words, bool optimize, const std::string& name) {
  Result<SpirvWords> shipped = optimize ? optimize_spirv(words, name) : Result<SpirvWords>(words);
  if (!shipped) return shipped;
  if (Status ok = validate_spirv(*shipped, name, "after the optimizer"); !ok) return tl::unexpected(ok.error());
  return shipped;
}

CacheKey program_key(const ClosureTask& task, const std::vector<SpirvWords>& frozen, bool optimize) {
  std::string options = optimize ? "optimized" : "as written";
  for (const Target& target : task.targets) options += " " + to_string(target);
  const std::string contract = describe_contract(task.closure.program);
  std::vector<std::string_view> parts = {compiler_version(), options, contract};
  for (std::size_t i = 0; i < frozen.size(); ++i) {
    parts.push_back(to_string(task.closure.program.shaders[i].stage));
    parts.push_back(bytes_of(frozen[i]));
  }
  return cache_key(parts);
}

/// The error with the permutation's name where the program's is.
Error named(Error error, const std::string& program, const std::string& permutation) {
  const std::size_t at = error.message.find(program);
  if (at != std::string::npos) error.message.replace(at, program.size(), permutation);
  return error;
}

/// In an archive's order: by stage, then language and version.
ProgramImage image_of(CompiledProgram compiled, std::vector<Target> targets, std::string cost) {
  std::sort(targets.begin(), targets.end(), [](const Target& a, const Target& b) {
    return std::pair(a.language, a.version) < std::pair(b.language, b.version);
  });
  std::sort(compiled.shaders.begin(), compiled.shaders.end(),
            [](const CompiledShader& a, const CompiledShader& b) { return a.stage < b.stage; });
  ProgramImage image;
  for (CompiledShader& shader : compiled.shaders) {
    for (const Target& target : targets) {
      const bool is_spirv = target.language == Language::spirv;
      image.outputs.push_back(
          {shader.stage, target,
           is_spirv ? std::string(bytes_of(shader.spirv)) : std::move(shader.text.at(to_string(target)))});
    }
  }
  image.reflection = std::move(compiled.reflection);
  image.cost = std::move(cost);
  return image;
}

/// Keeps what the last batch used: shaders that many programs share come again in the next one.
template <class Memo>
void keep_used(Memo& memo, std::vector<CacheKey> used) {
  std::sort(used.begin(), used.end());
  std::erase_if(memo, [&](const auto& entry) { return !std::binary_search(used.begin(), used.end(), entry.first); });
}

}  // namespace

/// Makes every wanted thing that the memo does not have, each once.
template <class Make>
void ClosureCompiler::fill(Memo& memo, const std::vector<std::pair<CacheKey, Make>>& wanted) const {
  std::vector<std::pair<Words*, const Make*>> missing;
  for (const auto& [key, make] : wanted) {
    const auto [entry, is_new] = memo.try_emplace(key);
    if (is_new) missing.emplace_back(&entry->second, &make);
  }
  run_parallel(missing.size(), threads_, [&](std::size_t i) {
    Words& words = *missing[i].first;
    const double start = thread_seconds();
    Result<SpirvWords> made = (*missing[i].second)();
    words.seconds = thread_seconds() - start;
    if (made) {
      words.words = std::make_shared<const SpirvWords>(*std::move(made));
    } else {
      words.error = made.error();
    }
  });
}

void ClosureCompiler::run_front_ends(std::span<const ClosureTask> tasks, std::vector<Item>& items) {
  struct Make {
    const ComposedShader* shader;
    const std::string* name;
    Result<SpirvWords> operator()() const { return front_end(*shader, *name); }
  };
  std::vector<std::pair<CacheKey, Make>> wanted;
  std::vector<CacheKey> used;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const ComposedProgram& program = tasks[i].closure.program;
    for (const ComposedShader& shader : program.shaders) {
      items[i].sources.push_back(source_key(shader));
      wanted.push_back({items[i].sources.back(), {&shader, &program.key}});
      used.push_back(items[i].sources.back());
    }
  }
  fill(sources_, wanted);
  keep_used(sources_, std::move(used));
}

void ClosureCompiler::freeze_all(std::span<const ClosureTask> tasks, std::vector<Item>& items,
                                 std::vector<ClosureOutcome>& outcomes) {
  run_parallel(tasks.size(), threads_, [&](std::size_t i) {
    for (const CacheKey& source : items[i].sources) {
      const Words& words = sources_.find(source)->second;
      if (words.error && !outcomes[i].error) outcomes[i].error = words.error;
      if (outcomes[i].error) continue;
      items[i].frozen.push_back(freeze(*words.words, tasks[i].closure.frozen));
      items[i].modules.push_back(cache_key({bytes_of(items[i].frozen.back())}));
    }
    if (!outcomes[i].error) outcomes[i].program = program_key(tasks[i], items[i].frozen, optimize_);
  });
}

void ClosureCompiler::optimize_all(std::span<const ClosureTask> tasks, std::vector<Item>& items,
                                   std::vector<ClosureOutcome>& outcomes) {
  struct Make {
    const SpirvWords* words;
    bool optimize;
    const std::string* name;
    Result<SpirvWords> operator()() const { return ship(*words, optimize, *name); }
  };
  std::vector<std::pair<CacheKey, Make>> wanted;
  std::vector<CacheKey> used;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (outcomes[i].error) continue;
    used.insert(used.end(), items[i].modules.begin(), items[i].modules.end());
    if (programs_.contains(outcomes[i].program)) continue;
    for (std::size_t s = 0; s < items[i].modules.size(); ++s) {
      wanted.push_back({items[i].modules[s], {&items[i].frozen[s], optimize_, &tasks[i].closure.program.key}});
    }
  }
  fill(modules_, wanted);
  keep_used(modules_, std::move(used));
}

/// Parses the modules that several new programs have, so that each is parsed and emitted once.
ClosureCompiler::SharedModules ClosureCompiler::parse_shared(std::span<const ClosureTask> tasks,
                                                             const std::vector<Item>& items,
                                                             const std::vector<std::size_t>& first, EmitMemo& memo) {
  std::map<CacheKey, std::pair<std::size_t, ShaderStage>> uses;
  for (const std::size_t i : first) {
    for (std::size_t s = 0; s < items[i].modules.size(); ++s) {
      auto& [count, stage] = uses[items[i].modules[s]];
      ++count;
      stage = tasks[i].closure.program.shaders[s].stage;
    }
  }
  SharedModules shared;
  for (const auto& [key, use] : uses) {
    const Words& words = modules_.find(key)->second;
    if (use.first < 2 || words.error) continue;
    Result<ShaderModule> module = parse_module(use.second, words.words, "");
    if (!module) continue;  // emitting says what is wrong
    memo.share(*module);
    shared.emplace(key, *std::move(module));
  }
  return shared;
}

Result<std::vector<ShaderModule>> ClosureCompiler::modules_of(const ClosureTask& task, const Item& item,
                                                              const SharedModules& shared) const {
  std::vector<ShaderModule> modules;
  for (std::size_t s = 0; s < item.modules.size(); ++s) {
    if (const auto known = shared.find(item.modules[s]); known != shared.end()) {
      modules.push_back(known->second);
      continue;
    }
    const Words& words = modules_.find(item.modules[s])->second;
    if (words.error) return tl::unexpected(*words.error);
    Result<ShaderModule> module =
        parse_module(task.closure.program.shaders[s].stage, words.words, task.closure.program.key);
    if (!module) return tl::unexpected(module.error());
    modules.push_back(*std::move(module));
  }
  return modules;
}

Result<ProgramImage> ClosureCompiler::emit(const ClosureTask& task, std::span<const ShaderModule> modules,
                                           const CacheKey& key, EmitMemo& memo) const {
  ComposedProgram program = task.closure.program;
  std::vector<SpirvWords> words;
  for (const ShaderModule& module : modules) words.push_back(*module.spirv);
  std::string cost = describe_cost(program, words);
  CompileOptions options;
  options.validate = false;      // each module was, once
  program.key = to_string(key);  // what the reflection calls it: many permutations share it
  Crew this_thread(1);
  Result<CompiledProgram> compiled =
      emit_program(program, modules, task.targets, options, task.closure.fallback, {{}, &memo}, this_thread);
  if (!compiled) return tl::unexpected(named(compiled.error(), program.key, task.closure.program.key));
  return image_of(*std::move(compiled), task.targets, std::move(cost));
}

void ClosureCompiler::emit_all(std::span<const ClosureTask> tasks, const std::vector<Item>& items,
                               std::vector<ClosureOutcome>& outcomes) {
  std::vector<std::size_t> first;  // the first task of every new program
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (!outcomes[i].error && programs_.try_emplace(outcomes[i].program).second) first.push_back(i);
  }
  EmitMemo memo;
  const SharedModules shared = parse_shared(tasks, items, first, memo);
  run_parallel(first.size(), threads_, [&](std::size_t k) {
    const std::size_t i = first[k];
    const double start = thread_seconds();
    const Result<std::vector<ShaderModule>> modules = modules_of(tasks[i], items[i], shared);
    Result<ProgramImage> image = modules ? emit(tasks[i], *modules, outcomes[i].program, memo)
                                         : Result<ProgramImage>(tl::unexpected(modules.error()));
    if (image) {
      outcomes[i].image = std::make_shared<const ProgramImage>(*std::move(image));
    } else {
      outcomes[i].error = image.error();
    }
    outcomes[i].seconds += thread_seconds() - start;
  });
  for (const std::size_t i : first) programs_[outcomes[i].program] = outcomes[i].error;
  for (ClosureOutcome& outcome : outcomes) {
    if (!outcome.error) outcome.error = programs_.find(outcome.program)->second;
  }
}

std::vector<ClosureOutcome> ClosureCompiler::compile(std::span<const ClosureTask> tasks, bool check_only) {
  std::vector<Item> items(tasks.size());
  std::vector<ClosureOutcome> outcomes(tasks.size());
  run_front_ends(tasks, items);
  if (check_only) {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      for (const CacheKey& source : items[i].sources) {
        if (!outcomes[i].error) outcomes[i].error = sources_.find(source)->second.error;
      }
    }
    return outcomes;
  }
  freeze_all(tasks, items, outcomes);
  optimize_all(tasks, items, outcomes);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    for (const CacheKey& source : items[i].sources) outcomes[i].seconds += sources_.find(source)->second.seconds;
    for (const CacheKey& module : items[i].modules) {
      const auto found = modules_.find(module);
      if (found != modules_.end()) outcomes[i].seconds += found->second.seconds;
    }
  }
  emit_all(tasks, items, outcomes);
  return outcomes;
}

}  // namespace relievo
