/// The speed-against-error plots, drawn by gnuplot in a process of its own.
#pragma once

#include <string>

#include "report/sweep.hpp"

namespace relievo::cli {

/// An SVG element to put into a page, or the sentence that says why there is none.
struct Plot {
  double angle = 0;  ///< degrees
  std::string svg, problem;
};

/// Time ratio to relief mapping (across) against wrong hits in percent (up), logarithmic both ways, for one angle:
/// a curve a technique, solid with the hardware filter and dashed with the exact one.
Plot draw_plot(const Sweep& sweep, double angle);

/// The gnuplot script and its data in one text; for tests. Empty when no point has a time.
std::string plot_script(const Sweep& sweep, double angle);

}  // namespace relievo::cli
