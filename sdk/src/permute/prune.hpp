/// Why a permutation is left out for a target.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "compose/resolve.hpp"
#include "relievo/permute.hpp"

namespace relievo {

/// Answers for one manifest; remembers what the capability table said.
class Pruner {
 public:
  explicit Pruner(const Manifest& manifest) : manifest_(manifest) {}

  /// One sentence a target of the manifest; empty: kept.
  std::vector<std::string> reasons(const Parts& parts, const Permutation& permutation);

 private:
  std::string scene_reason(const Parts& parts) const;
  std::string rule_reason(const Parts& parts, const Facts& facts) const;
  const std::string& capability_reason(const Parts& parts, const Target& target);

  const Manifest& manifest_;
  std::map<std::string, std::string> capabilities_;  // by stage, features and target
};

}  // namespace relievo
