/// FLIP again, slowly: in double, every filter as one square of weights, every formula where it is used.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace relievo::flip_reference {

using Color = std::array<double, 3>;

struct Picture {
  int width, height;
  std::vector<Color> pixels;
  const Color& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1))];
  }
};

inline double decode(std::uint8_t code) {
  double c = code / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

inline Color xyz(const Color& c) {
  return {0.4123907993 * c[0] + 0.3575843394 * c[1] + 0.1804807884 * c[2],
          0.2126390059 * c[0] + 0.7151686788 * c[1] + 0.0721923154 * c[2],
          0.0193308187 * c[0] + 0.1191947798 * c[1] + 0.9505321522 * c[2]};
}

inline Color rgb(const Color& c) {
  return {3.2409699419 * c[0] - 1.5373831776 * c[1] - 0.4986107603 * c[2],
          -0.9692436363 * c[0] + 1.8759675015 * c[1] + 0.0415550574 * c[2],
          0.0556300797 * c[0] - 0.2039769589 * c[1] + 1.0569715142 * c[2]};
}

inline Color hunt_lab(const Color& linear) {
  Color white = xyz({1, 1, 1}), c = xyz(linear), f;
  for (std::size_t i = 0; i < 3; ++i) {
    double t = c[i] / white[i];
    f[i] = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  }
  double l = 116 * f[1] - 16;
  return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

inline double hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Weights of a (2r+1)² square, by the distance in pixels.
template <class Weight>
std::vector<double> square(int r, Weight weight) {
  std::vector<double> weights;
  for (int y = -r; y <= r; ++y) {
    for (int x = -r; x <= r; ++x) weights.push_back(weight(x, y));
  }
  return weights;
}

inline double filter(const Picture& p, std::size_t channel, int x, int y, int r, const std::vector<double>& weights) {
  double sum = 0;
  std::size_t k = 0;
  for (int j = -r; j <= r; ++j) {
    for (int i = -r; i <= r; ++i) sum += weights[k++] * p.at(x + i, y + j)[channel];
  }
  return sum;
}

/// Positive weights add up to 1, negative ones to −1; or all of them to 1 when none is negative.
inline void normalise(std::vector<double>& weights) {
  double positive = 0, negative = 0;
  for (double w : weights) (w > 0 ? positive : negative) += std::abs(w);
  for (double& w : weights) w /= w > 0 ? positive : negative > 0 ? negative : 1;
}

inline Picture opponent(std::span<const std::uint8_t> image, int width, int height) {
  Picture picture{width, height, {}};
  Color white = xyz({1, 1, 1});
  for (std::size_t i = 0; i < image.size(); i += 4) {
    Color c = xyz({decode(image[i]), decode(image[i + 1]), decode(image[i + 2])});
    double x = c[0] / white[0], y = c[1] / white[1], z = c[2] / white[2];
    picture.pixels.push_back({116 * y - 16, 500 * (x - y), 200 * (y - z)});
  }
  return picture;
}

inline std::vector<Color> perceived(const Picture& picture, double ppd) {
  constexpr double pi = 3.14159265358979323846;
  constexpr double a1[] = {1, 1, 34.1}, b1[] = {0.0047, 0.0053, 0.04}, a2[] = {0, 0, 13.5}, b2[] = {1e-5, 1e-5, 0.025};
  int r = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
  std::array<std::vector<double>, 3> weights;
  for (std::size_t c = 0; c < 3; ++c) {
    weights[c] = square(r, [&](int x, int y) {
      double d2 = (x * x + y * y) / (ppd * ppd);
      return a1[c] * std::sqrt(pi / b1[c]) * std::exp(-pi * pi * d2 / b1[c]) +
             a2[c] * std::sqrt(pi / b2[c]) * std::exp(-pi * pi * d2 / b2[c]);
    });
    normalise(weights[c]);
  }
  Color white = xyz({1, 1, 1});
  std::vector<Color> colors;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      Color f;
      for (std::size_t c = 0; c < 3; ++c) f[c] = filter(picture, c, x, y, r, weights[c]);
      double luminance = (f[0] + 16) / 116;
      Color linear =
          rgb({(luminance + f[1] / 500) * white[0], luminance * white[1], (luminance - f[2] / 200) * white[2]});
      for (double& v : linear) v = std::clamp(v, 0.0, 1.0);
      colors.push_back(hunt_lab(linear));
    }
  }
  return colors;
}

/// Lengths of the edge (first) and point (second) detectors' answers.
inline std::vector<std::array<double, 2>> features(const Picture& picture, double ppd) {
  double s = 0.5 * 0.082 * ppd;
  int r = static_cast<int>(std::ceil(3 * s));
  auto gauss = [&](int x, int y) { return std::exp(-(x * x + y * y) / (2 * s * s)); };
  std::array<std::vector<double>, 4> weights = {
      square(r, [&](int x, int y) { return -x * gauss(x, y); }),
      square(r, [&](int x, int y) { return -y * gauss(x, y); }),
      square(r, [&](int x, int y) { return (x * x / (s * s) - 1) * gauss(x, y); }),
      square(r, [&](int x, int y) { return (y * y / (s * s) - 1) * gauss(x, y); })};
  for (std::vector<double>& w : weights) normalise(w);
  std::vector<std::array<double, 2>> lengths;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      std::array<double, 4> f;
      // The offset 16 of Y drops out: the weights of each filter add up to 0.
      for (std::size_t k = 0; k < 4; ++k) f[k] = filter(picture, 0, x, y, r, weights[k]) / 116;
      lengths.push_back({std::hypot(f[0], f[1]), std::hypot(f[2], f[3])});
    }
  }
  return lengths;
}

inline std::vector<double> flip(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height,
                                double ppd) {
  Picture picture_a = opponent(a, width, height), picture_b = opponent(b, width, height);
  std::vector<Color> colors_a = perceived(picture_a, ppd), colors_b = perceived(picture_b, ppd);
  auto features_a = features(picture_a, ppd), features_b = features(picture_b, ppd);
  double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
  std::vector<double> map;
  for (std::size_t i = 0; i < colors_a.size(); ++i) {
    double e = std::pow(hyab(colors_a[i], colors_b[i]), 0.7);
    double color = e < 0.4 * largest ? 0.95 * e / (0.4 * largest) : 0.95 + 0.05 * (e - 0.4 * largest) / (0.6 * largest);
    double feature = std::sqrt(
        std::max(std::abs(features_a[i][0] - features_b[i][0]), std::abs(features_a[i][1] - features_b[i][1])) /
        std::sqrt(2.0));
    map.push_back(std::pow(color, 1 - feature));
  }
  return map;
}

}  // namespace relievo::flip_reference
