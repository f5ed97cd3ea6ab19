#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "files/whole_file.hpp"
#include "image/decode.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wimplicit-fallthrough"
#pragma GCC diagnostic ignored "-Wsign-compare"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_PSD
#define STBI_NO_GIF
#define STBI_NO_PIC
#define STBI_NO_PNM
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace relievo {

namespace {

/// Feeds stb and notices when it asks for more than there is: stb itself reads zeros then, and calls it a picture.
class Stream {
 public:
  /// At the end of an HDR file stb 2.27 takes the zeros it reads for empty runs and loops for ever; `endless_runs`
  /// feeds it runs that are too long instead, which it rejects.
  explicit Stream(Bytes bytes, bool endless_runs = false) : bytes_(bytes), endless_runs_(endless_runs) {}
  bool overran() const { return overran_; }

  static int read(void* user, char* data, int size) {
    auto& self = *static_cast<Stream*>(user);
    // The first read fills stb's look-ahead buffer; into that one a short read is no fault, an empty one is.
    if (self.look_ahead_ == nullptr) self.look_ahead_ = data;
    const std::size_t rest = self.bytes_.size() - self.position_;
    const std::size_t count = std::min(rest, static_cast<std::size_t>(std::max(size, 0)));
    if (count > 0) std::memcpy(data, self.bytes_.data() + self.position_, count);
    self.position_ += count;
    if (count == 0 || (count < static_cast<std::size_t>(size) && data != self.look_ahead_)) self.overran_ = true;
    if (count == 0 && self.endless_runs_) {
      std::memset(data, 0xff, static_cast<std::size_t>(size));
      return size;
    }
    return static_cast<int>(count);
  }

  static void skip(void* user, int count) {
    auto& self = *static_cast<Stream*>(user);
    if (count < 0) return;
    const std::size_t rest = self.bytes_.size() - self.position_;
    if (static_cast<std::size_t>(count) > rest) self.overran_ = true;
    self.position_ += std::min(rest, static_cast<std::size_t>(count));
  }

  static int at_end(void* user) {
    const auto& self = *static_cast<Stream*>(user);
    return self.position_ >= self.bytes_.size() ? 1 : 0;
  }

 private:
  Bytes bytes_;
  std::size_t position_ = 0;
  const char* look_ahead_ = nullptr;
  bool endless_runs_;
  bool overran_ = false;
};

constexpr stbi_io_callbacks callbacks = {Stream::read, Stream::skip, Stream::at_end};

struct StbFree {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

tl::unexpected<Error> decode_error(const ImageSource& source, const Stream& stream) {
  if (stream.overran()) {
    return file_error(source.path, "image.truncated",
                      fmt::format("is truncated: it ends after {} bytes, before its last pixel", source.bytes.size()));
  }
  const char* reason = stbi_failure_reason();
  return file_error(source.path, "image.corrupt",
                    fmt::format("cannot be decoded: {}", reason != nullptr ? reason : "the data is not valid"));
}

/// max 255 or 65535: the value's share of it, rounded once.
template <class T>
std::vector<float> to_unit(const T* pixels, std::size_t count, double max) {
  std::vector<float> values(count);
  std::transform(pixels, pixels + count, values.begin(), [max](T value) { return static_cast<float>(value / max); });
  return values;
}

enum class Depth { integer8, integer16, floating };

Depth depth_of(Bytes bytes) {
  Stream hdr(bytes), wide(bytes);
  if (stbi_is_hdr_from_callbacks(&callbacks, &hdr) != 0) return Depth::floating;
  return stbi_is_16_bit_from_callbacks(&callbacks, &wide) != 0 ? Depth::integer16 : Depth::integer8;
}

void* load(Depth depth, Stream& stream, Image& image) {
  int *w = &image.width, *h = &image.height, *c = &image.channels;
  switch (depth) {
    case Depth::integer8:
      return stbi_load_from_callbacks(&callbacks, &stream, w, h, c, 0);
    case Depth::integer16:
      return stbi_load_16_from_callbacks(&callbacks, &stream, w, h, c, 0);
    default:
      return stbi_loadf_from_callbacks(&callbacks, &stream, w, h, c, 0);
  }
}

std::vector<float> to_floats(Depth depth, const void* pixels, std::size_t count) {
  if (depth == Depth::integer8) return to_unit(static_cast<const std::uint8_t*>(pixels), count, 255.0);
  if (depth == Depth::integer16) return to_unit(static_cast<const std::uint16_t*>(pixels), count, 65535.0);
  const auto* floats = static_cast<const float*>(pixels);
  return std::vector<float>(floats, floats + count);
}

}  // namespace

Result<DecodedImage> decode_stb(const ImageSource& source) {
  Stream header(source.bytes);
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_callbacks(&callbacks, &header, &width, &height, &channels) == 0)
    return decode_error(source, header);
  if (auto extent = check_extent(source, width, height, max_image_extent); !extent)
    return tl::unexpected(extent.error());

  const Depth depth = depth_of(source.bytes);
  Stream stream(source.bytes, depth == Depth::floating);
  DecodedImage decoded;
  Image& image = decoded.image;
  std::unique_ptr<void, StbFree> pixels(load(depth, stream, image));
  if (!pixels || stream.overran()) return decode_error(source, stream);
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                            static_cast<std::size_t>(image.channels);
  image.pixels = to_floats(depth, pixels.get(), count);
  decoded.is_colour = image.channels >= 3;
  return decoded;
}

}  // namespace relievo
