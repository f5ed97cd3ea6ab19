/// The speed-against-error plots, drawn by gnuplot in a process of its own.
#pragma once

#include <string>
#include <vector>

#include "report/sweep.hpp"

namespace relievo::cli {

/// What a plot shows: a figure across and a figure up, both to be small, both on logarithmic axes.
struct PlotKind {
  const char* name;     ///< of letters, for identifiers
  const char* heading;  ///< a phrase
  const char* across;
  const char* up;
  double (*x)(const SweepRow&);  ///< not positive: not measured, left out
  double (*y)(const SweepRow&);
  bool exact_only;  ///< the hardware filter's rows would repeat the exact one's
};

/// Time against wrong hits, time against the 99th percentile of |ΔH|, fetches against wrong hits, steps against wrong
/// hits.
const std::vector<PlotKind>& plot_kinds();

/// An SVG element to put into a page, or the sentence that says why there is none.
struct Plot {
  std::string map;
  const PlotKind* kind = nullptr;
  std::string svg, problem;
};

/// A panel an angle, for one map on the sweep's first backend: a line a technique, filter and loop, solid with the
/// hardware filter and dashed with the exact one; what no other row is at once better in both figures than is ringed.
Plot draw_plot(const Sweep& sweep, const std::string& map, const PlotKind& kind, const std::vector<double>& angles);

/// The gnuplot script and its data in one text; for tests. Empty when no row has the figures.
std::string plot_script(const Sweep& sweep, const std::string& map, const PlotKind& kind,
                        const std::vector<double>& angles);

}  // namespace relievo::cli
