/// FLIP (Andersson et al. 2020): a colour pipeline and a feature pipeline, put together at the end.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "measure/flip_color.hpp"
#include "measure/flip_filters.hpp"
#include "relievo/measure.hpp"

namespace relievo {

namespace {

using flip_color::Color;
using flip_filters::ContrastSensitivity;
using flip_filters::FeatureKernels;
using flip_filters::Kernel;
using flip_filters::Plane;

using Planes = std::array<Plane, 3>;  // Y, Cx, Cz

Planes to_planes(std::span<const std::uint8_t> image, int width, int height) {
  Planes planes;
  std::size_t pixels = image.size() / 4;
  for (Plane& plane : planes) plane = {width, height, std::vector<float>(pixels)};
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* p = &image[4 * i];
    Color c = flip_color::to_ycxcz({flip_color::linear(p[0]), flip_color::linear(p[1]), flip_color::linear(p[2])});
    for (std::size_t k = 0; k < 3; ++k) planes[k].values[i] = c[k];
  }
  return planes;
}

/// The colour pipeline up to its metric: what the eye sees of the colours from where it is, as L*a*b* by Hunt.
std::vector<Color> perceived(const Planes& planes, const ContrastSensitivity& csf) {
  Plane y = convolve(planes[0], csf.luminance), cx = convolve(planes[1], csf.red_green),
        cz = convolve(planes[2], csf.blue_yellow);
  std::vector<Color> colors(y.values.size());
  for (std::size_t i = 0; i < colors.size(); ++i)
    colors[i] = flip_color::to_hunt_lab(flip_color::to_linear_rgb({y.values[i], cx.values[i], cz.values[i]}));
  return colors;
}

/// The colour metric. Large distances are compressed: the eye tells them apart less well.
class ColorError {
 public:
  float operator()(const Color& a, const Color& b) const {
    float e = std::pow(flip_color::hyab(a, b), exponent);
    if (e < knee * largest_) return share / (knee * largest_) * e;
    return std::min(share + (e - knee * largest_) / (largest_ - knee * largest_) * (1 - share), 1.0f);
  }

 private:
  static constexpr float exponent = 0.7f, knee = 0.4f, share = 0.95f;
  /// Green and blue are furthest apart of all displayable colours.
  float largest_ =
      std::pow(flip_color::hyab(flip_color::to_hunt_lab({0, 1, 0}), flip_color::to_hunt_lab({0, 0, 1})), exponent);
};

/// How strong an edge or a point is at every pixel: the length of (∂x, ∂y) by the given derivative.
std::vector<float> strength(const Plane& luminance, const Kernel& derivative, const Kernel& smooth) {
  Plane dx = convolve_y(convolve_x(luminance, derivative), smooth);
  Plane dy = convolve_y(convolve_x(luminance, smooth), derivative);
  std::vector<float> lengths(dx.values.size());
  for (std::size_t i = 0; i < lengths.size(); ++i)
    lengths[i] = std::sqrt(dx.values[i] * dx.values[i] + dy.values[i] * dy.values[i]);
  return lengths;
}

struct Features {
  std::vector<float> edges, points;
};

/// The feature pipeline, on luminance in [0,1].
Features features(Plane luminance, const FeatureKernels& kernels) {
  for (float& y : luminance.values) y = (y + 16) / 116;
  return {strength(luminance, kernels.edge, kernels.smooth), strength(luminance, kernels.point, kernels.smooth)};
}

float feature_error(const Features& a, const Features& b, std::size_t i) {
  float largest = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
  return std::min(std::sqrt(largest / std::numbers::sqrt2_v<float>), 1.0f);
}

}  // namespace

FlipDifference flip(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height,
                    double pixels_per_degree) {
  std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  assert(a.size() == b.size() && a.size() == 4 * pixels && pixels_per_degree >= 2);
  FlipDifference difference{0, std::vector<float>(pixels)};
  if (pixels == 0 || std::equal(a.begin(), a.end(), b.begin())) return difference;
  Planes planes_a = to_planes(a, width, height), planes_b = to_planes(b, width, height);
  ContrastSensitivity csf = flip_filters::contrast_sensitivity(pixels_per_degree);
  std::vector<Color> colors_a = perceived(planes_a, csf), colors_b = perceived(planes_b, csf);
  FeatureKernels kernels = flip_filters::feature_kernels(pixels_per_degree);
  Features features_a = features(std::move(planes_a[0]), kernels),
           features_b = features(std::move(planes_b[0]), kernels);
  ColorError color_error;
  double sum = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    // Features that come and go make a difference of colour easier to see: the final equation.
    difference.map[i] = std::pow(color_error(colors_a[i], colors_b[i]), 1 - feature_error(features_a, features_b, i));
    sum += static_cast<double>(difference.map[i]);
  }
  difference.mean = sum / static_cast<double>(pixels);
  return difference;
}

}  // namespace relievo
