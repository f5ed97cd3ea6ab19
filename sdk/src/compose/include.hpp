/// Expands #include in GLSL modules against the registry's source tree.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "relievo/describe.hpp"

namespace relievo {

/// Collects modules into one text. Each file enters once; `#line` keeps diagnostics at the author's file and line.
class SourceExpander {
 public:
  explicit SourceExpander(const SourceTree& tree) : tree_(tree) {}

  /// Appends the module and all that it includes. Errors: "compose.missing-include", "compose.include-escapes",
  /// "compose.include-cycle", at the line of the #include.
  Result<std::string> expand(const std::string& path);

  const std::vector<std::string>& files() const { return files_; }

 private:
  Status append(const std::string& path, std::string& text);
  Result<std::string> resolve(const std::string& includer, int line, const std::string& name) const;

  const SourceTree& tree_;
  std::vector<std::string> files_;  // in order of first use
  std::vector<std::string> open_;   // the chain of files being expanded
};

}  // namespace relievo
