/// Which programs an edit reaches.
#pragma once

#include <set>
#include <string>

#include "relievo/cache.hpp"
#include "relievo/compose.hpp"

namespace relievo {

/// Source paths whose text differs, or that only one of the two has.
struct SourceChanges {
  std::set<std::string, std::less<>> files;
  bool may_reach_all = false;  ///< a descriptor among them, or a file that came or went: names resolve differently
};
SourceChanges changes_between(const SourceTree& before, const SourceTree& after);

/// Whether a change of these files may change the program.
bool reaches(const SourceChanges& changes, const ComposedProgram& program);

/// Equal for programs that compile to the same and have the same values.
CacheKey fingerprint(const ComposedProgram& program);

}  // namespace relievo
