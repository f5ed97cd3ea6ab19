#include <fmt/format.h>
#include <zlib.h>

#include <string_view>

#include "files/whole_file.hpp"
#include "image/decode.hpp"

namespace relievo {

namespace {

std::uint32_t big_endian(Bytes bytes, std::size_t at) {
  return (std::uint32_t{bytes[at]} << 24) | (std::uint32_t{bytes[at + 1]} << 16) | (std::uint32_t{bytes[at + 2]} << 8) |
         bytes[at + 3];
}

}  // namespace

Status check_png(const ImageSource& source) {
  const Bytes bytes = source.bytes;
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length = big_endian(bytes, at);
    if (length > bytes.size() - at - 12) break;
    const std::string_view type(reinterpret_cast<const char*>(bytes.data() + at + 4), 4);
    const auto checksum = crc32(0, bytes.data() + at + 4, static_cast<uInt>(length + 4));
    if (checksum != big_endian(bytes, at + 8 + length)) {
      return file_error(source.path, "image.corrupt",
                        fmt::format("is corrupt: the PNG chunk at byte {} has the wrong checksum", at));
    }
    if (at == 8) {
      if (type != "IHDR" || length != 13)
        return file_error(source.path, "image.corrupt", "is corrupt: it has no PNG header");
      auto extent = check_extent(source, big_endian(bytes, 16), big_endian(bytes, 20), max_image_extent);
      if (!extent) return extent;
    }
    if (type == "IEND") return {};
    at += 12 + length;
  }
  return file_error(source.path, "image.truncated",
                    fmt::format("is truncated: it ends after {} bytes, before its last PNG chunk", bytes.size()));
}

}  // namespace relievo
