#pragma once

#include <vector>

#include "relievo/measure.hpp"

namespace relievo {

/// Nearest-rank quantiles: the smallest value that at least that share of the values do not exceed; 0 of no values.
/// Reorders `values`.
ErrorQuantiles quantiles(std::vector<double>& values);

}  // namespace relievo
