/// EXR in two ways: our own reader of scanlines that are uncompressed, RLE or ZIP, which most files are, and tinyexr
/// for PIZ and tiles. The packaged tinyexr 1.0.1 asserts on, overruns or leaves rows unset in damaged files, so all
/// that it gets has passed `parse_exr_header`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/decode.hpp"
#include "relievo/result.hpp"

namespace relievo {

enum class ExrCompression { none = 0, rle = 1, zips = 2, zip = 3, piz = 4 };
enum class ExrType { uint32 = 0, half = 1, float32 = 2 };

struct ExrChannel {
  std::string name;
  ExrType type = ExrType::half;
};

struct ExrHeader {
  ExrCompression compression = ExrCompression::none;
  bool is_tiled = false;
  int min_x = 0, min_y = 0, width = 0, height = 0;  ///< the data window
  std::vector<ExrChannel> channels;                 ///< in the order of the file's planes
  std::size_t end = 0;                              ///< bytes; the offset table follows
};

/// Reads the header of a single-part, flat EXR and checks every attribute that matters.
Result<ExrHeader> parse_exr_header(const ImageSource& source);

/// Which channels make the image, at most four: R, G, B, Y, A first; others in the file's order.
std::vector<int> exr_channel_order(const std::vector<ExrChannel>& channels);

/// One plane a channel in the file's order, width·height floats each.
using ExrPlanes = std::vector<std::vector<float>>;
Result<ExrPlanes> read_exr_scanlines(const ImageSource& source, const ExrHeader& header);
Result<ExrPlanes> read_exr_with_tinyexr(const ImageSource& source, const ExrHeader& header);

}  // namespace relievo
