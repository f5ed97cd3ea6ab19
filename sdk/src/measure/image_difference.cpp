#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "relievo/measure.hpp"

namespace relievo {

ImageDifference compare_images(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  assert(a.size() == b.size() && a.size() % 4 == 0);
  ImageDifference difference;
  std::size_t pixels = a.size() / 4, within = 0, both = 0, either = 0;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); i += 4) {
    int largest = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      int d = std::abs(static_cast<int>(a[i + c]) - static_cast<int>(b[i + c]));
      largest = std::max(largest, d);
      if (c < 3) squares += static_cast<double>(d) * d;
    }
    within += largest <= 1;
    difference.largest = std::max(difference.largest, largest);
    both += a[i + 3] > 0 && b[i + 3] > 0;
    either += a[i + 3] > 0 || b[i + 3] > 0;
  }
  if (pixels == 0) return difference;
  difference.within_percent = percent_of(within, pixels);
  double mean = squares / (3.0 * static_cast<double>(pixels));
  difference.psnr = mean > 0 ? 10 * std::log10(255.0 * 255.0 / mean) : std::numeric_limits<double>::infinity();
  if (either > 0) difference.mask_iou = static_cast<double>(both) / static_cast<double>(either);
  return difference;
}

namespace {

bool drawn_around(std::span<const std::uint8_t> image, int width, int height, int x, int y, int margin) {
  for (int j = y - margin; j <= y + margin; ++j) {
    for (int i = x - margin; i <= x + margin; ++i) {
      if (i < 0 || j < 0 || i >= width || j >= height) return false;
      if (image[(static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)) * 4 +
                3] == 0)
        return false;
    }
  }
  return true;
}

}  // namespace

std::uint64_t count_cracks(std::span<const std::uint8_t> image, std::span<const std::uint8_t> reference, int width,
                           int height, int margin) {
  assert(image.size() == reference.size());
  std::uint64_t cracks = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::size_t alpha =
          (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 4 + 3;
      if (image[alpha] == 0 && drawn_around(reference, width, height, x, y, margin)) ++cracks;
    }
  }
  return cracks;
}

}  // namespace relievo
