#pragma once

#include <vector>

#include "relievo/measure.hpp"

namespace relievo {

/// Nearest rank: the smallest value that at least the share `q` of the values do not exceed; NaN of no values.
/// Reorders `values`.
double quantile(std::vector<double>& values, double q);
ErrorQuantiles quantiles(std::vector<double>& values);

}  // namespace relievo
