#include "measure/flip_filters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relievo::flip_filters {

namespace {

constexpr double pi = std::numbers::pi;

/// One Gaussian of a sensitivity (the table of the contrast sensitivity functions): a·sqrt(π/b)·exp(−π²·x²/b), x in
/// degrees.
struct Gaussian {
  double a, b;
};
constexpr double widest = 0.04;  // b of blue-yellow

template <class Function>
std::vector<double> sample(int radius, Function function) {
  std::vector<double> values;
  for (int x = -radius; x <= radius; ++x) values.push_back(function(static_cast<double>(x)));
  return values;
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (double value : values) total += value;
  return total;
}

/// `positive` divides weights above 0, `negative` those below.
Kernel scaled(const std::vector<double>& values, double positive, double negative) {
  Kernel kernel;
  for (double value : values) kernel.push_back(static_cast<float>(value / (value > 0 ? positive : negative)));
  return kernel;
}

std::vector<Term> sensitivity(const std::vector<Gaussian>& gaussians, int radius, double pixels_per_degree) {
  std::vector<Term> terms;
  double total = 0;
  for (const Gaussian& g : gaussians) {
    std::vector<double> values = sample(radius, [&](double x) {
      double degrees = x / pixels_per_degree;
      return std::exp(-pi * pi * degrees * degrees / g.b);
    });
    double one_axis = sum(values), share = g.a * std::sqrt(pi / g.b) * one_axis * one_axis;
    terms.push_back({static_cast<float>(share), scaled(values, one_axis, one_axis)});
    total += share;
  }
  for (Term& term : terms) term.weight = static_cast<float>(term.weight / total);
  return terms;
}

Kernel balanced(const std::vector<double>& values) {
  double positive = 0, negative = 0;
  for (double value : values) (value > 0 ? positive : negative) += std::abs(value);
  return scaled(values, positive > 0 ? positive : 1, negative > 0 ? negative : 1);
}

}  // namespace

ContrastSensitivity contrast_sensitivity(double pixels_per_degree) {
  int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
  auto channel = [&](const std::vector<Gaussian>& g) { return sensitivity(g, radius, pixels_per_degree); };
  return {channel({{1, 0.0047}}), channel({{1, 0.0053}}), channel({{34.1, widest}, {13.5, 0.025}})};
}

FeatureKernels feature_kernels(double pixels_per_degree) {
  constexpr double edge_degrees = 0.082;  // width of an edge that is detected
  double deviation = 0.5 * edge_degrees * pixels_per_degree;
  int radius = static_cast<int>(std::ceil(3 * deviation));
  auto gauss = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  std::vector<double> smooth = sample(radius, gauss);
  return {scaled(smooth, sum(smooth), 1), balanced(sample(radius, [&](double x) { return -x * gauss(x); })),
          balanced(sample(radius, [&](double x) { return (x * x / (deviation * deviation) - 1) * gauss(x); }))};
}

Plane convolve_x(const Plane& plane, const Kernel& kernel) {
  Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
  int radius = static_cast<int>(kernel.size() / 2);
  std::vector<float> padded(static_cast<std::size_t>(plane.width) + kernel.size() - 1);
  for (int y = 0; y < plane.height; ++y) {
    const float* from = plane.row(y);
    float* to = result.row(y);
    std::fill_n(padded.begin(), radius, from[0]);
    std::copy_n(from, plane.width, padded.begin() + radius);
    std::fill_n(padded.end() - radius, radius, from[plane.width - 1]);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const float* shifted = padded.data() + k;
      for (int x = 0; x < plane.width; ++x) to[x] += kernel[k] * shifted[x];
    }
  }
  return result;
}

Plane convolve_y(const Plane& plane, const Kernel& kernel) {
  Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
  int radius = static_cast<int>(kernel.size() / 2);
  for (int y = 0; y < plane.height; ++y) {
    float* to = result.row(y);
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const float* from = plane.row(std::clamp(y + static_cast<int>(k) - radius, 0, plane.height - 1));
      for (int x = 0; x < plane.width; ++x) to[x] += kernel[k] * from[x];
    }
  }
  return result;
}

Plane convolve(const Plane& plane, const std::vector<Term>& terms) {
  Plane result{plane.width, plane.height, std::vector<float>(plane.values.size())};
  for (const Term& term : terms) {
    Plane part = convolve_y(convolve_x(plane, term.kernel), term.kernel);
    for (std::size_t i = 0; i < part.values.size(); ++i) result.values[i] += term.weight * part.values[i];
  }
  return result;
}

}  // namespace relievo::flip_filters
