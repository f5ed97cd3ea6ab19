#include <fmt/format.h>

#include <optional>

#include "files/whole_file.hpp"
#include "image/decode.hpp"

namespace relievo {

namespace {

enum Marker : std::uint8_t {
  stuffed = 0x00,
  huffman_tables = 0xc4,
  restart_first = 0xd0,
  restart_last = 0xd7,
  end_of_image = 0xd9,
  start_of_scan = 0xda,
};

/// Each table is 16 counts of codes and as many values; there are 256 values to code.
bool are_huffman_tables_sound(Bytes segment) {
  while (!segment.empty()) {
    if (segment.size() < 17) return false;
    std::size_t codes = 0;
    for (std::size_t i = 1; i <= 16; ++i) codes += segment[i];
    if (codes > 256 || segment.size() < 17 + codes) return false;
    segment = segment.subspan(17 + codes);
  }
  return true;
}

/// Where the marker behind a scan's coded data begins, or nothing at the end of the file.
std::optional<std::size_t> end_of_scan(Bytes bytes, std::size_t at) {
  for (; at + 1 < bytes.size(); ++at) {
    const std::uint8_t next = bytes[at + 1];
    const bool is_data = next == stuffed || next == 0xff || (next >= restart_first && next <= restart_last);
    if (bytes[at] == 0xff && !is_data) return at;
  }
  return std::nullopt;
}

}  // namespace

Status check_jpeg(const ImageSource& source) {
  const Bytes bytes = source.bytes;
  const auto corrupt = [&](std::size_t at) {
    return file_error(source.path, "image.corrupt",
                      fmt::format("is corrupt: its JPEG segment at byte {} is not valid", at));
  };
  for (std::size_t at = 2; at + 2 <= bytes.size();) {
    if (bytes[at] != 0xff) return corrupt(at);
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xff) {  // fill
      ++at;
      continue;
    }
    if (marker == end_of_image) return {};
    if (at + 4 > bytes.size()) break;
    const std::size_t length = (std::size_t{bytes[at + 2]} << 8) | bytes[at + 3];
    if (length < 2) return corrupt(at);
    if (at + 2 + length > bytes.size()) break;
    if (marker == huffman_tables && !are_huffman_tables_sound(bytes.subspan(at + 4, length - 2))) return corrupt(at);
    const std::size_t behind = at + 2 + length;
    const auto next = marker == start_of_scan ? end_of_scan(bytes, behind) : behind;
    if (!next) break;
    at = *next;
  }
  return file_error(source.path, "image.truncated",
                    fmt::format("is truncated: it ends after {} bytes, before the end of its JPEG", bytes.size()));
}

}  // namespace relievo
