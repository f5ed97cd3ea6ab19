#include "measure/quantiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relievo {

double quantile(std::vector<double>& values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

ErrorQuantiles quantiles(std::vector<double>& values) {
  return {quantile(values, 0.50), quantile(values, 0.99), quantile(values, 1.0)};
}

}  // namespace relievo
