/// 16-bit PNG, which stb does not write: each row by the filter "up", deflated by zlib (PNG specification, 2nd
/// edition).
#include <fmt/format.h>
#include <zlib.h>

#include <string_view>

#include "files/whole_file.hpp"
#include "relievo/image.hpp"

namespace relievo {

namespace {

using Buffer = std::vector<std::uint8_t>;

void append_big_endian(Buffer& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(Buffer& file, std::string_view type, const Buffer& data) {
  append_big_endian(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = file.size();
  file.insert(file.end(), type.begin(), type.end());
  file.insert(file.end(), data.begin(), data.end());
  append_big_endian(file,
                    static_cast<std::uint32_t>(crc32(0, file.data() + start, static_cast<uInt>(4 + data.size()))));
}

/// Colour type by channels: grey, grey and alpha, RGB, RGBA.
Buffer header(int width, int height, int channels) {
  constexpr std::uint8_t colour_types[] = {0, 4, 2, 6};
  Buffer data;
  append_big_endian(data, static_cast<std::uint32_t>(width));
  append_big_endian(data, static_cast<std::uint32_t>(height));
  data.insert(data.end(), {16, colour_types[channels - 1], 0, 0, 0});
  return data;
}

/// Each byte less the one above it; the first row less zeros.
Buffer filtered_rows(std::span<const std::uint16_t> pixels, std::size_t row) {
  constexpr std::uint8_t up = 2;
  Buffer above(2 * row), current(2 * row), result;
  result.reserve(pixels.size() * 2 + pixels.size() / row);
  for (std::size_t start = 0; start < pixels.size(); start += row) {
    for (std::size_t i = 0; i < row; ++i) {
      current[2 * i] = static_cast<std::uint8_t>(pixels[start + i] >> 8);
      current[2 * i + 1] = static_cast<std::uint8_t>(pixels[start + i]);
    }
    result.push_back(up);
    for (std::size_t i = 0; i < current.size(); ++i) result.push_back(static_cast<std::uint8_t>(current[i] - above[i]));
    std::swap(above, current);
  }
  return result;
}

}  // namespace

Status write_png(const std::filesystem::path& path, int width, int height, int channels,
                 std::span<const std::uint16_t> pixels) {
  const auto in_range = [](int extent, int most) { return extent >= 1 && extent <= most; };
  const bool good = in_range(width, max_image_extent) && in_range(height, max_image_extent) && in_range(channels, 4);
  const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  if (!good || pixels.size() != row * static_cast<std::size_t>(height)) {
    return file_error(path, "image.size",
                      fmt::format("cannot be written: {} values for {}x{} pixels of {} channels; a width and height of "
                                  "1 to {} and 1 to 4 channels are expected",
                                  pixels.size(), width, height, channels, max_image_extent));
  }
  const Buffer rows = filtered_rows(pixels, row);
  Buffer packed(compressBound(static_cast<uLong>(rows.size())));
  uLongf size = static_cast<uLongf>(packed.size());
  if (compress2(packed.data(), &size, rows.data(), static_cast<uLong>(rows.size()), Z_DEFAULT_COMPRESSION) != Z_OK ||
      size > 0x7fffffffu) {
    return file_error(path, "image.write", "cannot be written: encoding it as PNG fails");
  }
  packed.resize(size);
  Buffer file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(file, "IHDR", header(width, height, channels));
  append_chunk(file, "IDAT", packed);
  append_chunk(file, "IEND", {});
  return write_file(path, file, "image");
}

}  // namespace relievo
