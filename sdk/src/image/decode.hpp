/// One decoder a file format: bytes in, pixels out. All reject what is truncated or too large before allocating for it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "relievo/height_map.hpp"
#include "relievo/image.hpp"
#include "relievo/result.hpp"

namespace relievo {

using Bytes = std::span<const std::uint8_t>;

struct DecodedImage {
  Image image;
  bool is_colour = false;  ///< the first three channels are red, green, blue
};

/// The bytes of a file and the name for messages.
struct ImageSource {
  std::filesystem::path path;
  Bytes bytes;
};

/// PNG, BMP, TGA, JPEG, HDR.
Result<DecodedImage> decode_stb(const ImageSource& source);
Result<DecodedImage> decode_exr(const ImageSource& source);
Result<DecodedImage> decode_pfm(const ImageSource& source);

/// Finds the format by content and decodes; gzipped files are unpacked first.
Result<DecodedImage> decode_image(const ImageSource& source);

/// As `load_height_map`, from bytes.
Result<HeightMap> decode_height_map(const ImageSource& source);

/// Rejects extents outside 1…`max_extent`, and pixels that so few bytes cannot hold whatever the compression.
Status check_extent(const ImageSource& source, std::int64_t width, std::int64_t height, int max_extent);

/// Every chunk of a PNG is whole and has its checksum: stb checks neither.
Status check_png(const ImageSource& source);

/// The segments of a JPEG follow each other up to its end mark, and no Huffman table has more codes than stb 2.27 has
/// room for.
Status check_jpeg(const ImageSource& source);

/// Run-length BMPs, which stb does not read: rewritten as the same BMP without compression.
bool is_run_length_bmp(Bytes bytes);
Result<std::vector<std::uint8_t>> expand_bmp(const ImageSource& source);
/// The same BMP with every colour that an index can name, black where the file has none: stb 2.27 reads memory there
/// that it never wrote.
std::vector<std::uint8_t> with_whole_palette(Bytes bytes);

bool is_gzip(Bytes bytes);
/// Unpacks a gzip file. Errors: "image.truncated", "image.corrupt", and "image.size" beyond what an image may need.
Result<std::vector<std::uint8_t>> gunzip(const ImageSource& source);

}  // namespace relievo
