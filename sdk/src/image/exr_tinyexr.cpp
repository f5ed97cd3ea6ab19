#include <fmt/format.h>
#include <tinyexr.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "files/whole_file.hpp"
#include "image/exr.hpp"

namespace relievo {

namespace {

/// tinyexr's header and image, freed in its own way.
struct TinyExr {
  EXRHeader header;
  EXRImage image;
  bool has_image = false;

  TinyExr() {
    InitEXRHeader(&header);
    InitEXRImage(&image);
  }
  ~TinyExr() {
    if (has_image) FreeEXRImage(&image);
    FreeEXRHeader(&header);  // filled even where parsing fails
  }
  TinyExr(const TinyExr&) = delete;
  TinyExr& operator=(const TinyExr&) = delete;
};

tl::unexpected<Error> exr_error(const ImageSource& source, const char* reason) {
  std::string text = reason != nullptr ? reason : "its EXR data is not valid";
  FreeEXRErrorMessage(reason);
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return file_error(source.path, "image.corrupt", fmt::format("is truncated or corrupt: {}", text));
}

float sample(const unsigned char* plane, std::size_t index, ExrType type) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, plane + 4 * index, 4);
  return type == ExrType::uint32 ? static_cast<float>(bits) : std::bit_cast<float>(bits);
}

/// A rectangle of the picture in tinyexr's planes, `stride` samples a row.
struct Rectangle {
  unsigned char** planes;
  int x, y, width, height, stride;
};

void copy(const Rectangle& from, const ExrHeader& header, ExrPlanes& planes) {
  for (std::size_t c = 0; c < planes.size(); ++c) {
    for (int y = 0; y < from.height; ++y) {
      const std::size_t source = static_cast<std::size_t>(y) * static_cast<std::size_t>(from.stride);
      const std::size_t target = static_cast<std::size_t>(from.y + y) * static_cast<std::size_t>(header.width) +
                                 static_cast<std::size_t>(from.x);
      for (std::size_t x = 0; x < static_cast<std::size_t>(from.width); ++x) {
        planes[c][target + x] = sample(from.planes[c], source + x, header.channels[c].type);
      }
    }
  }
}

Status load(const ImageSource& source, TinyExr& file) {
  EXRVersion version;
  const char* reason = nullptr;
  if (ParseEXRVersionFromMemory(&version, source.bytes.data(), source.bytes.size()) != TINYEXR_SUCCESS ||
      ParseEXRHeaderFromMemory(&file.header, &version, source.bytes.data(), source.bytes.size(), &reason) !=
          TINYEXR_SUCCESS) {
    return exr_error(source, reason);
  }
  for (int c = 0; c < file.header.num_channels; ++c) {
    if (file.header.pixel_types[c] == TINYEXR_PIXELTYPE_HALF)
      file.header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
  }
  file.image.num_channels = file.header.num_channels;  // or it leaks the planes of a picture that fails
  if (LoadEXRImageFromMemory(&file.image, &file.header, source.bytes.data(), source.bytes.size(), &reason) !=
      TINYEXR_SUCCESS) {
    return exr_error(source, reason);
  }
  file.has_image = true;
  return {};
}

}  // namespace

Result<ExrPlanes> read_exr_with_tinyexr(const ImageSource& source, const ExrHeader& header) {
  TinyExr file;
  if (auto loaded = load(source, file); !loaded) return tl::unexpected(loaded.error());
  if (file.image.width != header.width || file.image.height != header.height ||
      file.header.num_channels != static_cast<int>(header.channels.size())) {
    return exr_error(source, nullptr);
  }
  ExrPlanes planes(header.channels.size());
  for (auto& plane : planes)
    plane.resize(static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height));
  if (file.image.tiles == nullptr) {
    copy({file.image.images, 0, 0, header.width, header.height, header.width}, header, planes);
    return planes;
  }
  for (int t = 0; t < file.image.num_tiles; ++t) {
    const EXRTile& tile = file.image.tiles[t];
    const int x = tile.offset_x * file.header.tile_size_x, y = tile.offset_y * file.header.tile_size_y;
    if (x < 0 || y < 0 || x >= header.width || y >= header.height || tile.images == nullptr)
      return exr_error(source, nullptr);
    copy({tile.images, x, y, std::min(tile.width, header.width - x), std::min(tile.height, header.height - y),
          file.header.tile_size_x},
         header, planes);
  }
  return planes;
}

}  // namespace relievo
