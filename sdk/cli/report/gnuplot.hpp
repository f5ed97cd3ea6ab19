/// gnuplot in a process of its own.
#pragma once

#include <string>

namespace relievo::cli {

struct Drawing {
  std::string svg;      ///< an <svg> element; its identifiers start with the prefix
  std::string problem;  ///< or the sentence that says why there is none
};

/// Runs `script`, which draws one SVG. `prefix` is of letters and digits, unique in the page that the element is for.
Drawing run_gnuplot(const std::string& script, const std::string& prefix);

}  // namespace relievo::cli
