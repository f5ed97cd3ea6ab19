#include <fmt/format.h>
#include <tinyexr.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "files/whole_file.hpp"
#include "relievo/image.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace relievo {

namespace {

Status check_size(const std::filesystem::path& path, int width, int height, int channels, std::size_t values) {
  const bool extent = width >= 1 && height >= 1 && width <= max_image_extent && height <= max_image_extent;
  const std::size_t pixels = extent ? static_cast<std::size_t>(width) * static_cast<std::size_t>(height) : 0;
  if (extent && channels >= 1 && channels <= 4 && values == pixels * static_cast<std::size_t>(channels)) return {};
  return file_error(
      path, "image.size",
      fmt::format("cannot be written: {} values for {}x{} pixels of {} channels; a width and height of 1 to {} "
                  "and 1 to 4 channels are expected",
                  values, width, height, channels, max_image_extent));
}

Status check_size(const std::filesystem::path& path, const Image& image) {
  return check_size(path, image.width, image.height, image.channels, image.pixels.size());
}

void append(void* user, void* data, int size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(user);
  const auto* from = static_cast<const std::uint8_t*>(data);
  bytes.insert(bytes.end(), from, from + size);
}

std::uint8_t to_byte(float value) {
  if (!(value > 0)) return 0;  // NaN too
  return static_cast<std::uint8_t>(std::lround(std::fmin(value, 1.0f) * 255.0f));
}

std::array<std::uint8_t, 4> little_endian(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8), static_cast<std::uint8_t>(bits >> 16),
          static_cast<std::uint8_t>(bits >> 24)};
}

/// EXR stores channels in alphabetical order: names[k] holds our channel source[k].
struct ExrLayout {
  std::array<const char*, 4> names;
  std::array<int, 4> source;
};

ExrLayout exr_layout(int channels) {
  if (channels == 1) return {{"Y"}, {0}};
  if (channels == 2) return {{"G", "R"}, {1, 0}};
  if (channels == 3) return {{"B", "G", "R"}, {2, 1, 0}};
  return {{"A", "B", "G", "R"}, {3, 2, 1, 0}};
}

std::vector<float> plane_of(const Image& image, int channel) {
  const auto channels = static_cast<std::size_t>(image.channels);
  std::vector<float> plane(image.pixels.size() / channels);
  for (std::size_t i = 0; i < plane.size(); ++i)
    plane[i] = image.pixels[i * channels + static_cast<std::size_t>(channel)];
  return plane;
}

}  // namespace

Status write_png(const std::filesystem::path& path, int width, int height, int channels,
                 std::span<const std::uint8_t> pixels) {
  if (auto size = check_size(path, width, height, channels, pixels.size()); !size) return size;
  std::vector<std::uint8_t> bytes;
  if (stbi_write_png_to_func(append, &bytes, width, height, channels, pixels.data(), width * channels) == 0) {
    return file_error(path, "image.write", "cannot be written: encoding it as PNG fails");
  }
  return write_file(path, bytes, "image");
}

Status write_png(const std::filesystem::path& path, const Image& image) {
  if (auto size = check_size(path, image); !size) return size;
  std::vector<std::uint8_t> pixels(image.pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = to_byte(image.pixels[i]);
  return write_png(path, image.width, image.height, image.channels, pixels);
}

Status write_pfm(const std::filesystem::path& path, const Image& image) {
  if (auto size = check_size(path, image); !size) return size;
  if (image.channels != 1 && image.channels != 3) {
    return file_error(path, "image.size",
                      fmt::format("cannot be written: PFM holds 1 or 3 channels, and {} are given", image.channels));
  }
  const std::string header =
      fmt::format("{}\n{} {}\n-1.0\n", image.channels == 3 ? "PF" : "Pf", image.width, image.height);
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  bytes.reserve(bytes.size() + image.pixels.size() * 4);
  const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  for (std::size_t y = static_cast<std::size_t>(image.height); y-- > 0;) {  // PFM begins at the bottom
    for (std::size_t x = 0; x < row; ++x) {
      const auto value = little_endian(image.pixels[y * row + x]);
      bytes.insert(bytes.end(), value.begin(), value.end());
    }
  }
  return write_file(path, bytes, "image");
}

Status write_exr(const std::filesystem::path& path, const Image& image) {
  if (auto size = check_size(path, image); !size) return size;
  const ExrLayout layout = exr_layout(image.channels);
  std::array<std::vector<float>, 4> planes;
  std::array<unsigned char*, 4> plane_pointers = {};
  std::array<EXRChannelInfo, 4> channels = {};
  std::array<int, 4> types = {TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT,
                              TINYEXR_PIXELTYPE_FLOAT};
  for (std::size_t c = 0; c < static_cast<std::size_t>(image.channels); ++c) {
    planes[c] = plane_of(image, layout.source[c]);
    plane_pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
    std::strncpy(channels[c].name, layout.names[c], 255);
  }

  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = image.channels;
  header.channels = channels.data();
  header.pixel_types = types.data();
  header.requested_pixel_types = types.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  EXRImage exr;
  InitEXRImage(&exr);
  exr.num_channels = image.channels;
  exr.images = plane_pointers.data();
  exr.width = image.width;
  exr.height = image.height;

  unsigned char* memory = nullptr;
  const char* reason = nullptr;
  const std::size_t size = SaveEXRImageToMemory(&exr, &header, &memory, &reason);
  const std::vector<std::uint8_t> bytes(memory, memory + size);
  std::free(memory);
  if (size == 0) {
    auto error =
        file_error(path, "image.write", fmt::format("cannot be written: {}", reason != nullptr ? reason : "EXR fails"));
    FreeEXRErrorMessage(reason);
    return error;
  }
  return write_file(path, bytes, "image");
}

}  // namespace relievo
