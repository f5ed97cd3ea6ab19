#include <algorithm>
#include <numeric>
#include <string_view>

#include "image/exr.hpp"

namespace relievo {

std::vector<int> exr_channel_order(const std::vector<ExrChannel>& channels) {
  constexpr std::string_view known = "RGBYA";
  const auto rank = [&](int c) {
    const std::string& name = channels[static_cast<std::size_t>(c)].name;
    return std::min(name.size() == 1 ? known.find(name) : std::string_view::npos, known.size());
  };
  std::vector<int> order(channels.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });
  if (order.size() > 4) order.resize(4);
  return order;
}

Result<DecodedImage> decode_exr(const ImageSource& source) {
  const auto header = parse_exr_header(source);
  if (!header) return tl::unexpected(header.error());
  const bool is_plain = !header->is_tiled && header->compression != ExrCompression::piz;
  const auto planes = is_plain ? read_exr_scanlines(source, *header) : read_exr_with_tinyexr(source, *header);
  if (!planes) return tl::unexpected(planes.error());

  const std::vector<int> order = exr_channel_order(header->channels);
  DecodedImage decoded;
  Image& image = decoded.image;
  image.width = header->width;
  image.height = header->height;
  image.channels = static_cast<int>(order.size());
  image.pixels.resize(planes->front().size() * order.size());
  for (std::size_t c = 0; c < order.size(); ++c) {
    const std::vector<float>& plane = (*planes)[static_cast<std::size_t>(order[c])];
    for (std::size_t i = 0; i < plane.size(); ++i) image.pixels[i * order.size() + c] = plane[i];
  }
  decoded.is_colour = order.size() >= 3 && header->channels[static_cast<std::size_t>(order[2])].name == "B";
  return decoded;
}

}  // namespace relievo
