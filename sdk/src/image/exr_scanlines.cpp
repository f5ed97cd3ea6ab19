#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "files/whole_file.hpp"
#include "image/exr.hpp"

namespace relievo {

namespace {

using Block = std::vector<std::uint8_t>;

std::uint32_t little_endian(const std::uint8_t* bytes, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value |= std::uint32_t{bytes[i]} << (8 * i);
  return value;
}

std::size_t bytes_of(ExrType type) {
  return type == ExrType::half ? 2 : 4;
}

float half_to_float(std::uint32_t bits) {
  const std::uint32_t sign = (bits & 0x8000u) << 16, exponent = (bits >> 10) & 31, mantissa = bits & 0x3ffu;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000u | (mantissa << 13));
  const float magnitude = exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                                        : std::bit_cast<float>(((exponent + 112) << 23) | (mantissa << 13));
  return sign != 0 ? -magnitude : magnitude;
}

float sample(const std::uint8_t* bytes, ExrType type) {
  if (type == ExrType::half) return half_to_float(little_endian(bytes, 2));
  const std::uint32_t bits = little_endian(bytes, 4);
  return type == ExrType::uint32 ? static_cast<float>(bits) : std::bit_cast<float>(bits);
}

/// Runs: a count of at most 127 repeats the next byte once more than that, a negative one takes so many literally.
bool unpack_runs(Bytes codes, Block& block) {
  std::size_t to = 0;
  for (std::size_t at = 0; at + 1 < codes.size();) {
    const auto count = static_cast<std::int8_t>(codes[at++]);
    const bool literal = count < 0;
    const auto length = static_cast<std::size_t>(literal ? -int{count} : int{count} + 1);
    const std::size_t used = literal ? length : 1;
    if (used > codes.size() - at || length > block.size() - to) return false;
    if (literal) {
      std::copy_n(codes.begin() + static_cast<std::ptrdiff_t>(at), length,
                  block.begin() + static_cast<std::ptrdiff_t>(to));
    } else {
      std::fill_n(block.begin() + static_cast<std::ptrdiff_t>(to), length, codes[at]);
    }
    at += used;
    to += length;
  }
  return to == block.size();
}

bool unpack_zip(Bytes codes, Block& block) {
  auto size = static_cast<uLongf>(block.size());
  return uncompress(block.data(), &size, codes.data(), static_cast<uLong>(codes.size())) == Z_OK &&
         size == block.size();
}

/// Undoes what EXR does before RLE and ZIP: bytes as differences, those at even places before those at odd ones.
Block undo_prediction(Block block) {
  for (std::size_t i = 1; i < block.size(); ++i) block[i] = static_cast<std::uint8_t>(block[i - 1] + block[i] - 128);
  Block ordered(block.size());
  const std::size_t half = (block.size() + 1) / 2;
  for (std::size_t i = 0; i < ordered.size(); ++i) ordered[i] = block[(i % 2) * half + i / 2];
  return ordered;
}

/// A block of `size` bytes, or an empty one when its codes are not valid.
Block unpack(Bytes codes, std::size_t size, ExrCompression compression) {
  if (codes.size() == size) return {codes.begin(), codes.end()};  // stored plain when packing would not help
  Block block(size);
  const bool valid = compression == ExrCompression::rle    ? unpack_runs(codes, block)
                     : compression == ExrCompression::none ? false
                                                           : unpack_zip(codes, block);
  return valid ? undo_prediction(std::move(block)) : Block();
}

}  // namespace

Result<ExrPlanes> read_exr_scanlines(const ImageSource& source, const ExrHeader& header) {
  const Bytes bytes = source.bytes;
  const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.height);
  const std::size_t lines = header.compression == ExrCompression::zip ? 16 : 1;
  std::size_t line_size = 0;
  for (const ExrChannel& channel : header.channels) line_size += width * bytes_of(channel.type);

  ExrPlanes planes(header.channels.size());
  for (auto& plane : planes) plane.reserve(width * height);
  for (std::size_t line = 0; line < height; line += lines) {
    const std::uint8_t* entry = bytes.data() + header.end + line / lines * 8;
    const std::uint64_t offset = little_endian(entry, 4) | (std::uint64_t{little_endian(entry + 4, 4)} << 32);
    const std::size_t room = offset < bytes.size() ? bytes.size() - static_cast<std::size_t>(offset) : 0;
    const std::uint8_t* start = bytes.data() + (bytes.size() - room);
    const std::uint32_t size = room >= 8 ? little_endian(start + 4, 4) : 0;
    if (room < 8 || size > room - 8) {
      return file_error(source.path, "image.truncated",
                        fmt::format("is truncated: it ends after {} bytes, before its line {}", bytes.size(), line));
    }
    const std::size_t count = std::min(lines, height - line);
    const bool is_its_place =
        static_cast<std::int32_t>(little_endian(start, 4)) == header.min_y + static_cast<std::int32_t>(line);
    const Block block =
        is_its_place ? unpack(bytes.subspan(bytes.size() - room + 8, size), count * line_size, header.compression)
                     : Block();
    if (block.empty()) {
      return file_error(source.path, "image.corrupt",
                        fmt::format("is corrupt: its EXR block at line {} is not valid", line));
    }
    const std::uint8_t* from = block.data();
    for (std::size_t row = 0; row < count; ++row) {
      for (std::size_t c = 0; c < planes.size(); ++c) {
        const std::size_t step = bytes_of(header.channels[c].type);
        for (std::size_t x = 0; x < width; ++x, from += step)
          planes[c].push_back(sample(from, header.channels[c].type));
      }
    }
  }
  return planes;
}

}  // namespace relievo
