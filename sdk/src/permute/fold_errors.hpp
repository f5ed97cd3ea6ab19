/// The same error in many permutations, said once.
#pragma once

#include <string>
#include <vector>

#include "relievo/permute.hpp"

namespace relievo {

class ErrorFolder {
 public:
  /// Counts `count` permutations more that have the error, one of which is called `permutation`; `key` is how the
  /// error's message names it.
  void add(const Error& error, const std::string& key, const std::string& permutation, std::size_t count);

  /// The most frequent first, then in the order of their places.
  std::vector<FoldedError> take();

 private:
  std::vector<FoldedError> folded_;
};

}  // namespace relievo
