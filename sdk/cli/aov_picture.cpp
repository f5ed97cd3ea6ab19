#include "aov_picture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace relievo::cli {

namespace {

/// Of the first channel, where something was drawn.
struct Range {
  float near = 0, far = 0;  ///< all but the least and the greatest hundredth lie between
  float most = 0;

  float share(float value) const { return far > near ? std::clamp((value - near) / (far - near), 0.0f, 1.0f) : 0; }
};

bool is_drawn(const float* pixel) {
  return pixel[3] > 0;
}

Range range_of(const Image& numbers) {
  std::vector<float> values;
  for (std::size_t i = 0; i < numbers.pixels.size(); i += 4) {
    if (is_drawn(&numbers.pixels[i])) values.push_back(numbers.pixels[i]);
  }
  if (values.empty()) return {};
  const auto hundredth = static_cast<std::ptrdiff_t>(values.size() / 100);
  const auto near = values.begin() + hundredth, far = values.end() - 1 - hundredth;
  std::nth_element(values.begin(), far, values.end());
  const float most = *std::max_element(far, values.end());
  std::nth_element(values.begin(), near, far);
  return {*near, *far, most};
}

void set_grey(float* pixel, float grey) {
  std::fill_n(pixel, 3, grey);
}

void show(float* pixel, Aov aov, const Range& range) {
  switch (aov) {
    case Aov::normal:
    case Aov::ray_direction:
      std::transform(pixel, pixel + 3, pixel, [](float x) { return 0.5f + 0.5f * x; });
      break;
    case Aov::uv:
      std::transform(pixel, pixel + 3, pixel, [](float x) { return x - std::floor(x); });
      break;
    case Aov::depth:
      set_grey(pixel, 1 - 0.9f * range.share(*pixel));
      break;
    case Aov::steps:
      set_grey(pixel, range.most > 0 ? *pixel / range.most : 0);
      break;
    case Aov::status:
      set_grey(pixel, (*pixel + 1) / 5);
      break;
    case Aov::color:
    case Aov::ray_origin:
      break;
  }
}

}  // namespace

Image aov_picture(Image numbers, Aov aov) {
  const Range range = range_of(numbers);
  for (std::size_t i = 0; i < numbers.pixels.size(); i += 4) {
    float* pixel = &numbers.pixels[i];
    if (is_drawn(pixel)) {
      show(pixel, aov, range);
    } else {
      set_grey(pixel, 0);
    }
    pixel[3] = 1;
  }
  return numbers;
}

}  // namespace relievo::cli
