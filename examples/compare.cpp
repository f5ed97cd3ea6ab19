/// Compares two pictures: compare A B STEPS SHARE exits with 0 when at least SHARE of the pixels (in [0,1]) differ by
/// at most STEPS of 255 in every channel but alpha, and says how many do.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "relievo/image.hpp"

namespace {

struct Difference {
  double within = 0;  ///< share of the pixels
  int largest = 0;    ///< steps of 255
};

int steps_between(const relievo::Image& a, const relievo::Image& b, int x, int y) {
  float largest = 0;
  for (int c = 0; c < std::min(3, a.channels); ++c)
    largest = std::max(largest, std::abs(a.at(x, y, c) - b.at(x, y, c)));
  return static_cast<int>(std::lround(largest * 255));
}

Difference compare(const relievo::Image& a, const relievo::Image& b, int steps) {
  Difference result;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const int distance = steps_between(a, b, x, y);
      result.within += distance <= steps;
      result.largest = std::max(result.largest, distance);
    }
  }
  result.within /= static_cast<double>(a.width) * a.height;
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: compare A B STEPS SHARE\n");
    return 1;
  }
  const auto a = relievo::load_image(argv[1]), b = relievo::load_image(argv[2]);
  for (const auto* image : {&a, &b}) {
    if (*image) continue;
    std::fprintf(stderr, "%s\n", relievo::format(image->error()).c_str());
    return 1;
  }
  if (a->width != b->width || a->height != b->height || a->channels != b->channels) {
    std::fprintf(stderr, "the pictures differ in size or channels\n");
    return 1;
  }
  const int steps = std::atoi(argv[3]);
  const double share = std::atof(argv[4]);
  const Difference found = compare(*a, *b, steps), equal = compare(*a, *b, 0);
  std::printf("%.4f %% of the pixels are within %d/255, %.4f %% are equal; the largest difference is %d/255\n",
              found.within * 100, steps, equal.within * 100, found.largest);
  if (found.within >= share) return 0;
  std::printf("expected at least %.4f %%\n", share * 100);
  return 4;
}
