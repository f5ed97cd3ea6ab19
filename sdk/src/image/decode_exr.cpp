#include <fmt/format.h>
#include <tinyexr.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

#include "image/decode.hpp"
#include "image/file.hpp"

namespace relievo {

namespace {

/// tinyexr's header and image, freed in its own way.
struct ExrFile {
  EXRHeader header;
  EXRImage image;
  bool has_header = false, has_image = false;

  ExrFile() {
    InitEXRHeader(&header);
    InitEXRImage(&image);
  }
  ~ExrFile() {
    if (has_image) FreeEXRImage(&image);
    if (has_header) FreeEXRHeader(&header);
  }
  ExrFile(const ExrFile&) = delete;
  ExrFile& operator=(const ExrFile&) = delete;
};

tl::unexpected<Error> exr_error(const ImageSource& source, const char* reason) {
  std::string text = reason != nullptr ? reason : "its EXR data is not valid";
  FreeEXRErrorMessage(reason);
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return file_error(source.path, "image.corrupt", fmt::format("is truncated or corrupt: {}", text));
}

Status read_header(const ImageSource& source, ExrFile& file) {
  EXRVersion version;
  if (ParseEXRVersionFromMemory(&version, source.bytes.data(), source.bytes.size()) != TINYEXR_SUCCESS) {
    return exr_error(source, nullptr);
  }
  if (version.multipart != 0 || version.non_image != 0) {
    return file_error(source.path, "image.format", "is a multi-part or deep EXR; a single flat image is expected");
  }
  const char* reason = nullptr;
  if (ParseEXRHeaderFromMemory(&file.header, &version, source.bytes.data(), source.bytes.size(), &reason) !=
      TINYEXR_SUCCESS) {
    return exr_error(source, reason);
  }
  file.has_header = true;
  return {};
}

Status check_header(const ImageSource& source, const EXRHeader& header) {
  const EXRBox2i& window = header.data_window;
  auto extent = check_extent(source, std::int64_t{window.max_x} - window.min_x + 1,
                             std::int64_t{window.max_y} - window.min_y + 1, max_image_extent);
  if (!extent) return extent;
  if (header.num_channels < 1) return file_error(source.path, "image.format", "has no channel");
  for (int c = 0; c < header.num_channels; ++c) {
    if (header.channels[c].x_sampling != 1 || header.channels[c].y_sampling != 1) {
      return file_error(
          source.path, "image.format",
          fmt::format("has a subsampled channel '{}'; one sample a pixel is expected", header.channels[c].name));
    }
  }
  return {};
}

/// R, G, B, Y, A first; others keep the file's order, which is alphabetical.
std::vector<int> channel_order(const EXRHeader& header) {
  constexpr std::string_view known = "RGBYA";
  const auto rank = [&](int c) {
    const std::string_view name = header.channels[c].name;
    const std::size_t place = name.size() == 1 ? known.find(name) : std::string_view::npos;
    return std::min(place, known.size());
  };
  std::vector<int> order(static_cast<std::size_t>(header.num_channels));
  for (int c = 0; c < header.num_channels; ++c) order[static_cast<std::size_t>(c)] = c;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });
  if (order.size() > 4) order.resize(4);
  return order;
}

float sample(const unsigned char* plane, std::size_t index, int pixel_type) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, plane + 4 * index, 4);
  return pixel_type == TINYEXR_PIXELTYPE_UINT ? static_cast<float>(bits) : std::bit_cast<float>(bits);
}

/// A rectangle of the picture in tinyexr's planes, `stride` samples a row.
struct Block {
  unsigned char** planes;
  int x, y, width, height, stride;
};

void copy_block(const Block& block, const EXRHeader& header, const std::vector<int>& order, Image& image) {
  for (std::size_t c = 0; c < order.size(); ++c) {
    const int type = header.requested_pixel_types[order[c]];
    for (int y = 0; y < block.height; ++y) {
      for (int x = 0; x < block.width; ++x) {
        const auto from =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(block.stride) + static_cast<std::size_t>(x);
        const auto to = static_cast<std::size_t>(block.y + y) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(block.x + x);
        image.pixels[to * order.size() + c] = sample(block.planes[order[c]], from, type);
      }
    }
  }
}

void copy_pixels(const ExrFile& file, const std::vector<int>& order, Image& image) {
  if (file.image.tiles == nullptr) {
    copy_block({file.image.images, 0, 0, image.width, image.height, image.width}, file.header, order, image);
    return;
  }
  for (int t = 0; t < file.image.num_tiles; ++t) {
    const EXRTile& tile = file.image.tiles[t];
    const int x = tile.offset_x * file.header.tile_size_x, y = tile.offset_y * file.header.tile_size_y;
    if (x < 0 || y < 0 || x >= image.width || y >= image.height || tile.images == nullptr) continue;
    copy_block({tile.images, x, y, std::min(tile.width, image.width - x), std::min(tile.height, image.height - y),
                file.header.tile_size_x},
               file.header, order, image);
  }
}

}  // namespace

Result<DecodedImage> decode_exr(const ImageSource& source) {
  ExrFile file;
  if (auto read = read_header(source, file); !read) return tl::unexpected(read.error());
  if (auto valid = check_header(source, file.header); !valid) return tl::unexpected(valid.error());
  for (int c = 0; c < file.header.num_channels; ++c) {
    if (file.header.pixel_types[c] == TINYEXR_PIXELTYPE_HALF)
      file.header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
  }
  const char* reason = nullptr;
  if (LoadEXRImageFromMemory(&file.image, &file.header, source.bytes.data(), source.bytes.size(), &reason) !=
      TINYEXR_SUCCESS) {
    return exr_error(source, reason);
  }
  file.has_image = true;

  const std::vector<int> order = channel_order(file.header);
  DecodedImage decoded;
  decoded.image.width = file.image.width;
  decoded.image.height = file.image.height;
  decoded.image.channels = static_cast<int>(order.size());
  decoded.image.pixels.resize(static_cast<std::size_t>(file.image.width) * static_cast<std::size_t>(file.image.height) *
                              order.size());
  copy_pixels(file, order, decoded.image);
  decoded.is_colour = order.size() >= 3 && std::string_view(file.header.channels[order[2]].name) == "B";
  return decoded;
}

}  // namespace relievo
