/// Error figures of design.md §5: a technique's hits against the oracle's.
#pragma once

#include <cstdint>
#include <span>

#include "relievo/oracle.hpp"

namespace relievo {

/// Quantiles over hits that are neither missed, false nor wrong-layer.
struct ErrorQuantiles {
  double p50 = 0, p99 = 0, max = 0;
};

struct ErrorFigures {
  std::uint64_t rays = 0;       ///< all rays given
  std::uint64_t ambiguous = 0;  ///< set apart: not counted below
  std::uint64_t judged = 0;     ///< rays − ambiguous − those on which the oracle itself is exhausted
  std::uint64_t missed = 0;      ///< oracle hits, technique says miss or outside
  std::uint64_t false_hit = 0;   ///< technique hits, oracle does not
  std::uint64_t wrong_layer = 0; ///< both hit, more than 1 texel in uv or 0.02 in H apart
  std::uint64_t exhausted = 0;   ///< technique ran out of steps
  std::uint64_t non_finite = 0;  ///< NaN or Inf in any output
  ErrorQuantiles uv_texels;      ///< |Δuv| in texels (max norm over the axes)
  ErrorQuantiles height;         ///< |ΔH|
  double mean_steps = 0, mean_fetches = 0;

  double percent(std::uint64_t count) const { return judged ? 100.0 * static_cast<double>(count) / static_cast<double>(judged) : 0.0; }
  /// missed + false + wrong-layer, percent of judged rays.
  double wrong_percent() const { return percent(missed + false_hit + wrong_layer); }
};

/// Compares `measured` with `reference` ray by ray; both have the same length. width, height: the map's size in texels.
/// `inside` counts as a hit at t = 0 on both sides.
ErrorFigures compare_hits(std::span<const Hit> reference, std::span<const Hit> measured, int width, int height);

}  // namespace relievo
