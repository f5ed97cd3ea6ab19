#include "report/thumbnail.hpp"

#include <algorithm>
#include <cmath>

#include "common.hpp"
#include "report/html.hpp"

namespace relievo::cli {

namespace {

constexpr int largest_side = 160;         // pixels
constexpr int levels = 32;                // a channel: noise in the last bits is most of a PNG file
constexpr float page_background = 0.07f;  // of the page's figures

/// Channel c of a pixel over the background; a grey image has one channel for all.
float over(const Image& image, int x, int y, int c, float background) {
  bool has_alpha = image.channels == 2 || image.channels == 4;
  int colors = has_alpha ? image.channels - 1 : image.channels;
  float alpha = has_alpha ? image.at(x, y, image.channels - 1) : 1;
  return std::lerp(background, image.at(x, y, std::min(c, colors - 1)), alpha);
}

}  // namespace

Image reduce(const Image& image, int largest, float background, int levels) {
  int factor = (std::max(image.width, image.height) + largest - 1) / largest;
  Image small{std::max(1, image.width / factor), std::max(1, image.height / factor), 3, {}};
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        float sum = 0;
        int count = 0;
        for (int j = y * factor; j < std::min((y + 1) * factor, image.height); ++j) {
          for (int i = x * factor; i < std::min((x + 1) * factor, image.width); ++i, ++count)
            sum += over(image, i, j, c, background);
        }
        auto steps = static_cast<float>(levels - 1);
        small.pixels.push_back(std::round(sum / static_cast<float>(count) * steps) / steps);
      }
    }
  }
  return small;
}

Result<std::string> thumbnail_uri(const std::filesystem::path& folder, const std::string& file) {
  Result<Image> image = load_image(folder / file);
  if (!image) return tl::unexpected(image.error());
  if (Status status = make_folder(folder / "small"); !status) return tl::unexpected(status.error());
  std::filesystem::path path = folder / "small" / file;
  if (Status status = write_png(path, reduce(*image, largest_side, page_background, levels)); !status)
    return tl::unexpected(status.error());
  return png_uri(path);
}

}  // namespace relievo::cli
