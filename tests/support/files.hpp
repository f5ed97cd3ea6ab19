/// Files for tests: a folder that vanishes, and small encoders of formats that the SDK only reads.
#pragma once

#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace relievo::test {

using ByteString = std::string;

/// A fresh folder, removed with all it holds.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "relievo-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder can be made as '" + name + "'");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

  std::filesystem::path write(std::string_view name, std::string_view content) const {
    std::ofstream(path_ / name, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
    return path_ / name;
  }
  static ByteString read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::size_t count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline ByteString bytes_of(std::uint64_t value, int count, bool big_endian) {
  ByteString bytes;
  for (int i = 0; i < count; ++i) {
    const int shift = 8 * (big_endian ? count - 1 - i : i);
    bytes += static_cast<char>((value >> shift) & 0xff);
  }
  return bytes;
}
inline ByteString big(std::uint64_t value, int count) {
  return bytes_of(value, count, true);
}
inline ByteString little(std::uint64_t value, int count) {
  return bytes_of(value, count, false);
}

inline std::uint32_t crc32_of(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/// Deflate without compression: one stored block, below 64 KiB.
inline ByteString stored_block(const ByteString& data) {
  return ByteString("\x01", 1) + little(data.size(), 2) + little(~data.size() & 0xffff, 2) + data;
}

inline ByteString zlib_stream(const ByteString& data) {
  std::uint32_t a = 1, b = 0;
  for (const char c : data) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  return ByteString("\x78\x01", 2) + stored_block(data) + big((b << 16) | a, 4);
}

inline ByteString gzip(const ByteString& data) {
  return ByteString("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10) + stored_block(data) + little(crc32_of(data), 4) +
         little(data.size(), 4);
}

inline ByteString png_chunk(const ByteString& type, const ByteString& data) {
  return big(data.size(), 4) + type + data + big(crc32_of(type + data), 4);
}

enum class PngColour { grey = 0, rgb = 2, palette = 3, grey_alpha = 4, rgba = 6 };

/// `rows` are the packed rows without their filter byte.
inline ByteString png(std::uint32_t width, std::uint32_t height, int depth, PngColour colour,
                      const std::vector<ByteString>& rows, const ByteString& palette = {}) {
  ByteString raw;
  for (const ByteString& row : rows) raw += '\0' + row;
  ByteString file = "\x89PNG\r\n\x1a\n";
  file += png_chunk("IHDR", big(width, 4) + big(height, 4) + big(static_cast<unsigned>(depth), 1) +
                                big(static_cast<unsigned>(colour), 1) + ByteString(3, '\0'));
  if (!palette.empty()) file += png_chunk("PLTE", palette);
  return file + png_chunk("IDAT", zlib_stream(raw)) + png_chunk("IEND", {});
}

/// An .npy file; `data` are the elements as `descr` says.
inline ByteString npy(const ByteString& descr, const ByteString& shape, const ByteString& data, bool fortran = false) {
  const ByteString header =
      "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }\n";
  return ByteString("\x93NUMPY\x01\x00", 8) + little(header.size(), 2) + header + data;
}

struct ZipEntry {
  ByteString name, data;
};

/// A zip archive without compression.
inline ByteString zip(const std::vector<ZipEntry>& entries) {
  ByteString file, directory;
  for (const auto& [name, data] : entries) {
    const ByteString common = little(20, 2) + ByteString(8, '\0') + little(crc32_of(data), 4) + little(data.size(), 4) +
                              little(data.size(), 4) + little(name.size(), 2) + little(0, 2);
    directory += "PK\x01\x02" + little(20, 2) + common + ByteString(10, '\0') + little(file.size(), 4) + name;
    file += "PK\x03\x04" + common + name + data;
  }
  return file + directory + "PK\x05\x06" + ByteString(4, '\0') + little(entries.size(), 2) + little(entries.size(), 2) +
         little(directory.size(), 4) + little(file.size(), 4) + little(0, 2);
}

/// A 4×2 8-bit BMP with a grey palette, run-length coded; the file's first row is the bottom one: 1 1 1 2, above 5 6 7
/// 0.
inline ByteString run_length_bmp() {
  ByteString palette;
  for (int i = 0; i < 256; ++i) palette += ByteString(3, static_cast<char>(i)) + '\0';
  const ByteString codes("\x03\x01\x01\x02\x00\x00\x00\x03\x05\x06\x07\x00\x00\x01", 14);
  const std::size_t offset = 14 + 40 + palette.size();
  const ByteString info = little(40, 4) + little(4, 4) + little(2, 4) + little(1, 2) + little(8, 2) + little(1, 4) +
                          little(codes.size(), 4) + ByteString(8, '\0') + little(256, 4) + little(0, 4);
  return "BM" + little(offset + codes.size(), 4) + ByteString(4, '\0') + little(offset, 4) + info + palette + codes;
}

}  // namespace relievo::test
