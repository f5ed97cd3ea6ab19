#include <fmt/format.h>

#include <algorithm>

#include "files/whole_file.hpp"
#include "image/decode.hpp"

namespace relievo {

namespace {

constexpr std::size_t header_size = 14 + 40;
constexpr std::uint32_t rle8 = 1, rle4 = 2;

std::uint32_t little_endian(Bytes bytes, std::size_t at) {
  return bytes[at] | (std::uint32_t{bytes[at + 1]} << 8) | (std::uint32_t{bytes[at + 2]} << 16) |
         (std::uint32_t{bytes[at + 3]} << 24);
}

void put_little_endian(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// Palette indices, bottom row first, rows padded to four bytes as an uncompressed BMP has them.
class IndexPlane {
 public:
  IndexPlane(std::size_t width, std::size_t height) : width_(width), height_(height), stride_((width + 3) / 4 * 4) {
    indices_.resize(stride_ * height);
  }
  void put(std::uint8_t index) {  // runs may end in padding beyond the row; it is dropped
    if (x_ < width_ && y_ < height_) indices_[y_ * stride_ + x_] = index;
    ++x_;
  }
  void next_row() {
    x_ = 0;
    ++y_;
  }
  void move(std::size_t dx, std::size_t dy) {
    x_ += dx;
    y_ += dy;
  }
  bool is_full() const { return y_ >= height_ || (y_ + 1 == height_ && x_ >= width_); }
  const std::vector<std::uint8_t>& indices() const { return indices_; }

 private:
  std::size_t width_, height_, stride_;
  std::size_t x_ = 0, y_ = 0;
  std::vector<std::uint8_t> indices_;
};

std::uint8_t nibble(std::uint8_t byte, std::size_t i) {
  return i % 2 == 0 ? byte >> 4 : byte & 15;
}

/// Reads run-length codes; false when they end before the picture does.
bool read_runs(Bytes codes, bool four_bits, IndexPlane& plane) {
  std::size_t at = 0;
  while (at + 2 <= codes.size()) {
    const std::uint8_t count = codes[at], value = codes[at + 1];
    at += 2;
    if (count > 0) {
      for (std::size_t i = 0; i < count; ++i) plane.put(four_bits ? nibble(value, i) : value);
    } else if (value == 0) {
      plane.next_row();
    } else if (value == 1) {
      return true;
    } else if (value == 2) {
      if (at + 2 > codes.size()) return false;
      plane.move(codes[at], codes[at + 1]);
      at += 2;
    } else {
      const std::size_t bytes = four_bits ? (value + 1u) / 2 : value;
      if (at + bytes > codes.size()) return false;
      for (std::size_t i = 0; i < value; ++i) plane.put(four_bits ? nibble(codes[at + i / 2], i) : codes[at + i]);
      at += (bytes + 1) / 2 * 2;  // literal runs are padded to 16 bits
    }
  }
  return plane.is_full();  // some writers leave the end mark out
}

}  // namespace

bool is_run_length_bmp(Bytes bytes) {
  if (bytes.size() < header_size || bytes[0] != 'B' || bytes[1] != 'M' || little_endian(bytes, 14) < 40) return false;
  const std::uint32_t bits = bytes[28], compression = little_endian(bytes, 30);
  return (compression == rle8 && bits == 8) || (compression == rle4 && bits == 4);
}

Result<std::vector<std::uint8_t>> expand_bmp(const ImageSource& source) {
  const Bytes bytes = source.bytes;
  const std::size_t offset = little_endian(bytes, 10);
  const auto width = static_cast<std::int32_t>(little_endian(bytes, 18));
  const auto height = static_cast<std::int32_t>(little_endian(bytes, 22));
  if (auto extent = check_extent(source, width, height, max_image_extent); !extent)
    return tl::unexpected(extent.error());
  if (offset < header_size || offset > bytes.size()) {
    return file_error(source.path, "image.truncated", "is truncated: it ends before the pixels of its BMP");
  }
  IndexPlane plane(static_cast<std::size_t>(width), static_cast<std::size_t>(height));
  if (!read_runs(bytes.subspan(offset), little_endian(bytes, 30) == rle4, plane)) {
    return file_error(source.path, "image.truncated",
                      fmt::format("is truncated: it ends after {} bytes, before its last pixel", bytes.size()));
  }
  std::vector<std::uint8_t> expanded(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  expanded[28] = 8;
  put_little_endian(expanded, 30, 0);
  expanded.insert(expanded.end(), plane.indices().begin(), plane.indices().end());
  return expanded;
}

std::vector<std::uint8_t> with_whole_palette(Bytes bytes) {
  std::vector<std::uint8_t> whole(bytes.begin(), bytes.end());
  if (bytes.size() < 14 + 12) return whole;
  const std::size_t info_size = little_endian(bytes, 14), offset = little_endian(bytes, 10);
  const bool is_core = info_size == 12;  // of OS/2
  if (!is_core && bytes.size() < header_size) return whole;
  const std::size_t bits = bytes[is_core ? 24 : 28], entry_size = is_core ? 3 : 4, start = 14 + info_size;
  if (bits > 8 || start > offset || offset > bytes.size()) return whole;
  const std::size_t entries = (offset - start) / entry_size, ignored_by_stb = is_core ? 4 : 0;
  const std::size_t needed = (std::size_t{1} << bits) + ignored_by_stb;
  if (entries == 0 || entries >= needed) return whole;
  const std::size_t pixels = start + needed * entry_size;
  whole.resize(start + entries * entry_size);
  whole.resize(pixels);  // black
  whole.insert(whole.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset), bytes.end());
  put_little_endian(whole, 10, static_cast<std::uint32_t>(pixels));
  return whole;
}

}  // namespace relievo
