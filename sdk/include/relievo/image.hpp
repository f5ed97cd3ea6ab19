/// Images in and out. Every write is atomic: a temporary file in the same folder is renamed once it is complete.
/// Every function here is thread-safe; of several writes to one path the last to end stays, whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "relievo/result.hpp"

namespace relievo {

/// `channels` floats a pixel, interleaved, row 0 (the top) first.
struct Image {
  int width = 0, height = 0;  ///< pixels, ≥ 1
  int channels = 0;           ///< 1–4
  std::vector<float> pixels;  ///< width·height·channels

  float at(int x, int y, int channel) const {
    return pixels[(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
                      static_cast<size_t>(channels) +
                  static_cast<size_t>(channel)];
  }
};

/// Largest accepted width or height of an image that is read or written, pixels.
inline constexpr int max_image_extent = 16384;

/// Writes 8 bits a channel: values are clamped to [0,1] (NaN is 0) and rounded to the nearest of 255 steps.
/// Errors of all writers: sizes that disagree ("image.size"), a file that cannot be written ("image.write").
Status write_png(const std::filesystem::path& path, const Image& image);

/// Writes 8-bit pixels as they are; `pixels` holds width·height·channels bytes.
Status write_png(const std::filesystem::path& path, int width, int height, int channels,
                 std::span<const std::uint8_t> pixels);

/// The same with 16 bits a channel, in the machine's byte order; the file is what PNG asks for.
Status write_png(const std::filesystem::path& path, int width, int height, int channels,
                 std::span<const std::uint16_t> pixels);

/// Writes lossless 32-bit floats, little-endian; 1 or 3 channels (2 and 4 are "image.size").
Status write_pfm(const std::filesystem::path& path, const Image& image);

/// Writes lossless 32-bit floats, ZIP-compressed; 1–4 channels, named Y, or the first of R, G, B, A.
Status write_exr(const std::filesystem::path& path, const Image& image);

/// Reads PNG (8/16 bit), BMP (also gzipped), TGA, JPEG, HDR, PFM or EXR. Integer channels map 0..max to [0,1]; floats
/// are as in the file, NaN and Inf included. EXR channels come in the order R, G, B, A; other names alphabetically, at
/// most four. Errors: missing, a folder, unreadable, truncated, larger than max_image_extent; id "image.*".
Result<Image> load_image(const std::filesystem::path& path);

}  // namespace relievo
