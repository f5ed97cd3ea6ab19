#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>

#include "files/whole_file.hpp"
#include "image/decode.hpp"

namespace relievo {

namespace {

/// An uncompressed colour image of the largest extent; more is no image but an attack.
constexpr std::size_t max_unpacked = static_cast<std::size_t>(max_image_extent) * max_image_extent * 4 + (1u << 20);

struct Inflater {
  z_stream stream = {};
  bool ready = false;
  Inflater() { ready = inflateInit2(&stream, 16 + MAX_WBITS) == Z_OK; }  // 16: expect a gzip header
  ~Inflater() {
    if (ready) inflateEnd(&stream);
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

}  // namespace

bool is_gzip(Bytes bytes) {
  return bytes.size() >= 2 && bytes[0] == 0x1f && bytes[1] == 0x8b;
}

Result<std::vector<std::uint8_t>> gunzip(const ImageSource& source) {
  Inflater inflater;
  if (!inflater.ready) return file_error(source.path, "image.memory", "cannot be unpacked: zlib does not start");
  z_stream& stream = inflater.stream;
  std::vector<std::uint8_t> unpacked;
  std::vector<std::uint8_t> block(1u << 16);
  Bytes rest = source.bytes;
  for (int status = Z_OK;;) {
    if (stream.avail_in == 0) {
      const std::size_t count = std::min<std::size_t>(rest.size(), 1u << 20);
      stream.next_in = const_cast<Bytef*>(rest.data());
      stream.avail_in = static_cast<uInt>(count);
      rest = rest.subspan(count);
    }
    stream.next_out = block.data();
    stream.avail_out = static_cast<uInt>(block.size());
    status = inflate(&stream, Z_NO_FLUSH);
    unpacked.insert(unpacked.end(), block.data(), block.data() + (block.size() - stream.avail_out));
    if (status == Z_STREAM_END) break;
    if (status == Z_BUF_ERROR || (status == Z_OK && stream.avail_in == 0 && rest.empty() && stream.avail_out > 0)) {
      return file_error(source.path, "image.truncated", "is truncated: its gzip data ends too early");
    }
    if (status != Z_OK) return file_error(source.path, "image.corrupt", "is corrupt: its gzip data does not unpack");
    if (unpacked.size() > max_unpacked) {
      return file_error(source.path, "image.size",
                        fmt::format("unpacks to more than the {} bytes that an image may have", max_unpacked));
    }
  }
  return unpacked;
}

}  // namespace relievo
