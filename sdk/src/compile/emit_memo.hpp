/// Texts of modules that many programs share, such as their vertex shader: emitted once.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "compile/bindings.hpp"
#include "compile/emit.hpp"
#include "compile/interface.hpp"
#include "relievo/cache.hpp"

namespace relievo {

/// Thread-safe.
class EmitMemo {
 public:
  using Texts = Result<std::vector<std::string>>;

  /// From now on this module's texts are kept.
  void share(const ShaderModule& module) { shared_.insert(module.spirv.get()); }

  /// What `emit` gives, or gave for the same module among the same resources and neighbours.
  Texts texts(const TargetFamily& family, const ShaderModule& module, const BindingLayout& layout,
              const StageNeighbours& neighbours, const std::function<Texts()>& emit);

 private:
  std::mutex mutex_;
  std::set<const SpirvWords*> shared_;  // by the words that copies of a module share; changed by no thread but one
  std::map<CacheKey, std::vector<std::string>> texts_;
};

}  // namespace relievo
