/// The filters of FLIP (Andersson et al. 2020), all of them sums of separable ones.
#pragma once

#include <cstddef>
#include <vector>

namespace relievo::flip_filters {

struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;

  float* row(int y) { return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
  const float* row(int y) const {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

/// Weights at −radius … radius pixels.
using Kernel = std::vector<float>;

/// A share of a sum of separable filters: the same kernel along x and y.
struct Term {
  float weight = 1;
  Kernel kernel;
};

/// The contrast sensitivity of the eye for one channel as a low-pass filter, sum of weights 1; its radius is that of
/// the widest channel.
struct ContrastSensitivity {
  std::vector<Term> luminance, red_green, blue_yellow;
};
ContrastSensitivity contrast_sensitivity(double pixels_per_degree);

/// A Gaussian and its first two derivatives, as wide as an edge that the eye detects; the derivatives' positive weights
/// add up to 1 and their negative ones to −1.
struct FeatureKernels {
  Kernel smooth, edge, point;
};
FeatureKernels feature_kernels(double pixels_per_degree);

/// Beyond its border a plane goes on with the border's values.
Plane convolve_x(const Plane& plane, const Kernel& kernel);
Plane convolve_y(const Plane& plane, const Kernel& kernel);
Plane convolve(const Plane& plane, const std::vector<Term>& terms);

}  // namespace relievo::flip_filters
