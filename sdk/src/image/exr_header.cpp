#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>

#include "files/whole_file.hpp"
#include "image/exr.hpp"

namespace relievo {

namespace {

constexpr std::uint32_t tiled_flag = 0x200, long_names_flag = 0x400;
constexpr int max_attributes = 100;  ///< tinyexr overruns its table beyond 128

/// Reads little-endian fields; what lies beyond the end makes `failed` true and reads as 0.
class Cursor {
 public:
  explicit Cursor(Bytes bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}
  bool failed() const { return failed_; }
  std::size_t at() const { return at_; }

  Bytes take(std::size_t count) {
    failed_ = failed_ || count > bytes_.size() - at_;
    if (failed_) return {};
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }
  std::uint32_t uint32() {
    const Bytes b = take(4);
    return b.empty() ? 0
                     : b[0] | (std::uint32_t{b[1]} << 8) | (std::uint32_t{b[2]} << 16) | (std::uint32_t{b[3]} << 24);
  }
  std::int32_t int32() { return static_cast<std::int32_t>(uint32()); }
  /// Up to and over its zero; at most 255 characters.
  std::string string() {
    const Bytes rest = bytes_.subspan(at_);
    const auto end = std::find(rest.begin(), rest.end(), 0);
    const auto length = static_cast<std::size_t>(end - rest.begin());
    failed_ = failed_ || end == rest.end() || length > 255;
    if (failed_) return {};
    at_ += length + 1;
    return {rest.begin(), end};
  }

 private:
  Bytes bytes_;
  std::size_t at_;
  bool failed_ = false;
};

struct Fault {
  std::string id, rest;
};
using Check = std::optional<Fault>;

Fault invalid(std::string_view attribute) {
  return {"image.corrupt", fmt::format("is corrupt: its EXR attribute '{}' is not valid", attribute)};
}

Check read_channels(Bytes data, ExrHeader& header) {
  Cursor cursor(data);
  header.channels.clear();
  for (std::string name = cursor.string(); !name.empty(); name = cursor.string()) {
    const std::uint32_t type = cursor.uint32();
    cursor.take(4);  // linearity, reserved
    const bool is_full = cursor.uint32() == 1 && cursor.uint32() == 1;
    if (cursor.failed() || type > 2) return invalid("channels");
    if (!is_full)
      return Fault{"image.format", fmt::format("has a subsampled channel '{}'; one sample a pixel is expected", name)};
    header.channels.push_back({name, static_cast<ExrType>(type)});
  }
  if (cursor.failed() || header.channels.empty()) return invalid("channels");
  return std::nullopt;
}

/// Everything that a reader of pixels relies on.
struct Attributes {
  bool compression = false, data_window = false, channels = false, tiles = false;
  std::int64_t width = 0, height = 0, tile_width = 1, tile_height = 1, chunk_count = -1;
  std::string type;
};

Check read_attribute(std::string_view name, Bytes data, ExrHeader& header, Attributes& seen) {
  Cursor cursor(data);
  if (name == "channels") {
    seen.channels = true;
    return read_channels(data, header);
  }
  if (name == "compression") {
    seen.compression = true;
    if (data.size() != 1) return invalid(name);
    if (data[0] > 4)
      return Fault{"image.format", fmt::format("is EXR of compression {}; none, RLE, ZIP or PIZ is expected", data[0])};
    header.compression = static_cast<ExrCompression>(data[0]);
  } else if (name == "dataWindow") {
    seen.data_window = true;
    if (data.size() != 16) return invalid(name);
    header.min_x = cursor.int32();
    header.min_y = cursor.int32();
    seen.width = std::int64_t{cursor.int32()} - header.min_x + 1;
    seen.height = std::int64_t{cursor.int32()} - header.min_y + 1;
    constexpr int far = 1 << 20;  // so that no sum of coordinates overflows
    if (std::max(std::abs(std::int64_t{header.min_x}), std::abs(std::int64_t{header.min_y})) > far)
      return invalid(name);
  } else if (name == "tiles") {
    seen.tiles = true;
    if (data.size() != 9) return invalid(name);
    seen.tile_width = cursor.uint32();
    seen.tile_height = cursor.uint32();
    const bool valid = std::min(seen.tile_width, seen.tile_height) >= 1 &&
                       std::max(seen.tile_width, seen.tile_height) <= max_image_extent;
    if (!valid || (data[8] & 15) > 2) return invalid(name);
  } else if (name == "chunkCount") {
    if (data.size() != 4) return invalid(name);
    seen.chunk_count = cursor.int32();
  } else if (name == "type") {
    seen.type.assign(data.begin(), std::find(data.begin(), data.end(), 0));
  } else if (data.empty() && name != "name") {
    return invalid(name);
  }
  return std::nullopt;
}

std::int64_t lines_per_block(ExrCompression compression) {
  if (compression == ExrCompression::zip) return 16;
  return compression == ExrCompression::piz ? 32 : 1;
}

/// The attributes against each other and the size of the file.
Check check_attributes(const ImageSource& source, const ExrHeader& header, const Attributes& seen) {
  if (!seen.channels) return invalid("channels");
  if (!seen.compression) return invalid("compression");
  if (!seen.data_window) return invalid("dataWindow");
  if (header.is_tiled != seen.tiles) return invalid("tiles");
  if (!seen.type.empty() && seen.type != (header.is_tiled ? "tiledimage" : "scanlineimage")) return invalid("type");
  const std::int64_t lines = lines_per_block(header.compression);
  std::int64_t blocks = (seen.height + lines - 1) / lines;
  if (header.is_tiled) {
    blocks = ((seen.width + seen.tile_width - 1) / seen.tile_width) *
             ((seen.height + seen.tile_height - 1) / seen.tile_height);
  } else if (seen.chunk_count > 0 && seen.chunk_count != blocks) {
    return invalid("chunkCount");
  }
  if (static_cast<std::uint64_t>(blocks) * 8 > source.bytes.size() - header.end) {
    return Fault{"image.truncated",
                 fmt::format("is truncated: it ends after {} bytes, in its EXR offset table", source.bytes.size())};
  }
  return std::nullopt;
}

}  // namespace

Result<ExrHeader> parse_exr_header(const ImageSource& source) {
  const auto fault = [&](const Fault& f) { return file_error(source.path, f.id, f.rest); };
  Cursor cursor(source.bytes, 4);
  const std::uint32_t version = cursor.uint32();
  if ((version & 0xff) != 2 || (version & ~std::uint32_t{0xff} & ~tiled_flag & ~long_names_flag) != 0) {
    return fault({"image.format", "is a multi-part or deep EXR or not of version 2; a single flat image is expected"});
  }
  ExrHeader header;
  header.is_tiled = (version & tiled_flag) != 0;
  Attributes seen;
  std::string name = cursor.string();
  for (int count = 0; !name.empty(); name = cursor.string()) {
    cursor.string();  // its type
    const Bytes data = cursor.take(cursor.uint32());
    if (cursor.failed()) break;
    if (++count > max_attributes)
      return fault({"image.format", fmt::format("has more than {} EXR attributes", max_attributes)});
    if (const Check check = read_attribute(name, data, header, seen)) return fault(*check);
  }
  if (cursor.failed()) return fault({"image.truncated", "is truncated: its EXR header ends too early"});
  header.end = cursor.at();
  if (seen.data_window) {
    auto extent = check_extent(source, seen.width, seen.height, max_image_extent);
    if (!extent) return tl::unexpected(extent.error());
  }
  if (const Check check = check_attributes(source, header, seen)) return fault(*check);
  header.width = static_cast<int>(seen.width);
  header.height = static_cast<int>(seen.height);
  return header;
}

}  // namespace relievo
