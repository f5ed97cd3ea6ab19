#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include "files/whole_file.hpp"
#include "image/decode.hpp"

namespace relievo {

namespace {

bool is_space(std::uint8_t c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

/// The next word of the header; `at` ends behind it. Empty at the end of the file.
std::string_view next_word(Bytes bytes, std::size_t& at) {
  while (at < bytes.size() && is_space(bytes[at])) ++at;
  const std::size_t begin = at;
  while (at < bytes.size() && !is_space(bytes[at]) && at - begin < 64) ++at;
  return {reinterpret_cast<const char*>(bytes.data() + begin), at - begin};
}

template <class T>
bool parse(std::string_view word, T& value) {
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return code == std::errc() && end == word.data() + word.size();
}

float read_float(const std::uint8_t* bytes, bool swap) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, bytes, 4);
  if (swap) bits = __builtin_bswap32(bits);
  return std::bit_cast<float>(bits);
}

}  // namespace

Result<DecodedImage> decode_pfm(const ImageSource& source) {
  std::size_t at = 0;
  DecodedImage decoded;
  Image& image = decoded.image;
  image.channels = next_word(source.bytes, at) == "PF" ? 3 : 1;
  double scale = 0;
  const bool valid = parse(next_word(source.bytes, at), image.width) &&
                     parse(next_word(source.bytes, at), image.height) && parse(next_word(source.bytes, at), scale) &&
                     scale != 0 && at < source.bytes.size();
  if (!valid) {
    return file_error(source.path, "image.corrupt", "is corrupt: its PFM header is not a width, a height and a scale");
  }
  ++at;  // exactly one white-space character ends the header
  if (auto extent = check_extent(source, image.width, image.height, max_image_extent); !extent) {
    return tl::unexpected(extent.error());
  }
  const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  const std::size_t rows = static_cast<std::size_t>(image.height);
  if (source.bytes.size() - at < row * rows * 4) {
    return file_error(
        source.path, "image.truncated",
        fmt::format("is truncated: it has {} bytes of pixels and needs {}", source.bytes.size() - at, row * rows * 4));
  }
  // The sign of the scale is the byte order; its magnitude is a unit of brightness that does not concern the values.
  const bool swap = (scale < 0) != (std::endian::native == std::endian::little);
  image.pixels.resize(row * rows);
  for (std::size_t y = 0; y < rows; ++y) {
    const std::uint8_t* from = source.bytes.data() + at + (rows - 1 - y) * row * 4;  // the file begins at the bottom
    for (std::size_t x = 0; x < row; ++x) image.pixels[y * row + x] = read_float(from + 4 * x, swap);
  }
  decoded.is_colour = image.channels == 3;
  return decoded;
}

}  // namespace relievo
