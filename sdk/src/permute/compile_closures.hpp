/// Compiling many closures, each different thing once.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compile/emit_memo.hpp"
#include "compile/shader_module.hpp"
#include "permute/closure.hpp"
#include "relievo/archive.hpp"

namespace relievo {

/// One closure to compile, for these targets.
struct ClosureTask {
  Closure closure;
  std::vector<Target> targets;
};

/// What became of it.
struct ClosureOutcome {
  /// Equal for closures with the same SPIR-V, contract and targets.
  CacheKey program;
  /// Null: another closure has, or had, the same program, or there is an error.
  std::shared_ptr<const ProgramImage> image;
  std::optional<Error> error;
  double seconds = 0;  ///< CPU time of what was done for this closure
};

/// Compiles batch after batch: in each, every different shader text goes through the front end once, every different
/// SPIR-V through the optimizer once, and every different program to the targets once. Keeps, from batch to batch,
/// what the last one used. The outcomes do not depend on the number of threads.
class ClosureCompiler {
 public:
  ClosureCompiler(unsigned threads, bool optimize) : threads_(threads), optimize_(optimize) {}

  /// With `check_only` nothing is done beyond the front end.
  std::vector<ClosureOutcome> compile(std::span<const ClosureTask> tasks, bool check_only = false);

 private:
  struct Words {
    std::shared_ptr<const SpirvWords> words;
    std::optional<Error> error;
    double seconds = 0;
  };
  using Memo = std::map<CacheKey, Words>;
  /// A closure on its way: keys into the memos, one a shader.
  struct Item {
    std::vector<CacheKey> sources, modules;
    std::vector<SpirvWords> frozen;
  };

  using SharedModules = std::map<CacheKey, ShaderModule>;

  SharedModules parse_shared(std::span<const ClosureTask> tasks, const std::vector<Item>& items,
                             const std::vector<std::size_t>& first, EmitMemo& memo);
  Result<std::vector<ShaderModule>> modules_of(const ClosureTask& task, const Item& item,
                                               const SharedModules& shared) const;
  Result<ProgramImage> emit(const ClosureTask& task, std::span<const ShaderModule> modules, const CacheKey& key,
                            EmitMemo& memo) const;

  template <class Make>
  void fill(Memo& memo, const std::vector<std::pair<CacheKey, Make>>& wanted) const;
  void run_front_ends(std::span<const ClosureTask> tasks, std::vector<Item>& items);
  void freeze_all(std::span<const ClosureTask> tasks, std::vector<Item>& items, std::vector<ClosureOutcome>& outcomes);
  void optimize_all(std::span<const ClosureTask> tasks, std::vector<Item>& items,
                    std::vector<ClosureOutcome>& outcomes);
  void emit_all(std::span<const ClosureTask> tasks, const std::vector<Item>& items,
                std::vector<ClosureOutcome>& outcomes);

  Memo sources_;                                       // shader text → the front end's SPIR-V, without lines
  Memo modules_;                                       // frozen SPIR-V → what ships
  std::map<CacheKey, std::optional<Error>> programs_;  // those that were emitted, or could not be
  unsigned threads_;
  bool optimize_;
};

}  // namespace relievo
