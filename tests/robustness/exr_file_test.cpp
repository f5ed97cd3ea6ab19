#include <gtest/gtest.h>
#include <tinyexr.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "image/decode.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {
namespace {

using Floats = std::vector<float>;

/// An EXR that tinyexr wrote: channels "X" of the type and "Z" as floats, so that their sizes differ.
std::vector<std::uint8_t> written_by_tinyexr(int width, int height, int compression, int type, const Floats& a,
                                             const Floats& b) {
  std::array<EXRChannelInfo, 2> channels = {};
  std::strcpy(channels[0].name, "X");
  std::strcpy(channels[1].name, "Z");
  Floats planes[2] = {a, b};
  std::array<unsigned char*, 2> images = {reinterpret_cast<unsigned char*>(planes[0].data()),
                                          reinterpret_cast<unsigned char*>(planes[1].data())};
  std::array<int, 2> given = {TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT},
                     stored = {type, TINYEXR_PIXELTYPE_FLOAT};
  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = 2;
  header.channels = channels.data();
  header.pixel_types = given.data();
  header.requested_pixel_types = stored.data();
  header.compression_type = compression;
  EXRImage image;
  InitEXRImage(&image);
  image.num_channels = 2;
  image.images = images.data();
  image.width = width;
  image.height = height;
  unsigned char* memory = nullptr;
  const std::size_t size = SaveEXRImageToMemory(&image, &header, &memory, nullptr);
  std::vector<std::uint8_t> bytes(memory, memory + size);
  std::free(memory);
  return bytes;
}

/// Halves hold these: multiples of 2⁻¹⁰ below 2, some negative, and runs of equal values.
Floats half_values(int width, int height) {
  Random random(7);
  Floats values;
  for (int i = 0; i < width * height; ++i) {
    const bool run = i % 40 > 25;
    values.push_back(run ? 0.5f : static_cast<float>(random.below(2047) - 1023) / 1024.0f);
  }
  values[0] = 5.9604645e-8f;  // the smallest denormal half
  return values;
}

constexpr std::array compressions = {TINYEXR_COMPRESSIONTYPE_NONE, TINYEXR_COMPRESSIONTYPE_RLE,
                                     TINYEXR_COMPRESSIONTYPE_ZIPS, TINYEXR_COMPRESSIONTYPE_ZIP,
                                     TINYEXR_COMPRESSIONTYPE_PIZ};

TEST(ExrFile, ReadsWhatAnotherProgramWrites) {
  for (const auto& [width, height] : {std::array{1, 1}, {37, 41}, {64, 16}, {5, 33}}) {
    const Floats a = half_values(width, height);
    Floats b = a;
    for (float& value : b) value = value * 3.7e5f + 0.1f;
    for (const int compression : compressions) {
      for (const int type : {TINYEXR_PIXELTYPE_HALF, TINYEXR_PIXELTYPE_FLOAT}) {
        const auto bytes = written_by_tinyexr(width, height, compression, type, a, b);
        const auto decoded = decode_exr({"a.exr", bytes});
        ASSERT_TRUE(decoded) << format(decoded.error()) << " compression " << compression << " type " << type;
        ASSERT_EQ(decoded->image.channels, 2);
        for (std::size_t i = 0; i < a.size(); ++i) {
          ASSERT_EQ(decoded->image.pixels[2 * i], a[i]) << compression << " " << type << " at " << i;
          ASSERT_EQ(decoded->image.pixels[2 * i + 1], b[i]) << compression << " " << type << " at " << i;
        }
      }
    }
  }
}

TEST(ExrFile, TruncationIsAnErrorInEveryCompression) {
  const Floats values = half_values(20, 18);
  for (const int compression : compressions) {
    const auto bytes = written_by_tinyexr(20, 18, compression, TINYEXR_PIXELTYPE_HALF, values, values);
    for (std::size_t length = 8; length < bytes.size(); length += 3) {
      const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
      ASSERT_FALSE(decode_exr({"a.exr", cut}).has_value()) << compression << " at " << length;
    }
  }
}

/// Our own reader alone: PIZ goes to tinyexr, whose decoder is not hardened.
TEST(ExrFile, DamageGivesAnImageOrAnError) {
  const Floats values = half_values(20, 18);
  for (const int compression :
       {TINYEXR_COMPRESSIONTYPE_NONE, TINYEXR_COMPRESSIONTYPE_RLE, TINYEXR_COMPRESSIONTYPE_ZIP}) {
    auto bytes = written_by_tinyexr(20, 18, compression, TINYEXR_PIXELTYPE_HALF, values, values);
    for (std::size_t at = 4; at < bytes.size(); ++at) {
      for (const int flip : {0x01, 0xff}) {
        auto damaged = bytes;
        damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ flip);
        const auto decoded = decode_exr({"a.exr", damaged});
        if (!decoded) {
          ASSERT_TRUE(decoded.error().id.starts_with("image."));
          continue;
        }
        const Image& image = decoded->image;
        ASSERT_EQ(image.pixels.size(), static_cast<std::size_t>(image.width * image.height * image.channels));
      }
    }
  }
}

}  // namespace
}  // namespace relievo::test
