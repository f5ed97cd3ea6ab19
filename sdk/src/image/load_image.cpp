#include <fmt/format.h>

#include <cctype>
#include <exception>
#include <string_view>

#include "files/whole_file.hpp"
#include "image/decode.hpp"

namespace relievo {

namespace {

bool starts_with(Bytes bytes, std::string_view magic) {
  return bytes.size() >= magic.size() &&
         std::string_view(reinterpret_cast<const char*>(bytes.data()), magic.size()) == magic;
}

/// TGA has no signature: the name decides ("a.tga", "a.tga.gz").
bool is_named_tga(std::filesystem::path path) {
  if (path.extension() == ".gz") path = path.stem();
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".tga";
}

}  // namespace

Status check_extent(const ImageSource& source, std::int64_t width, std::int64_t height, int max_extent) {
  if (width < 1 || height < 1 || width > max_extent || height > max_extent) {
    return file_error(source.path, "image.size",
                      fmt::format("is {}x{}; a width and height of 1 to {} are expected", width, height, max_extent));
  }
  // The densest code of all formats here is deflated 1-bit PNG: at most 1032 bytes from one, 8 pixels each.
  constexpr std::uint64_t max_pixels_per_byte = std::uint64_t{1032} * 8;
  if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) >
      max_pixels_per_byte * source.bytes.size()) {
    return file_error(
        source.path, "image.truncated",
        fmt::format("is truncated: its {} bytes cannot hold {}x{} pixels", source.bytes.size(), width, height));
  }
  return {};
}

Result<DecodedImage> decode_image(const ImageSource& source) {
  const Bytes bytes = source.bytes;
  if (is_gzip(bytes)) {
    const auto unpacked = gunzip(source);
    if (!unpacked) return tl::unexpected(unpacked.error());
    if (is_gzip(*unpacked)) return file_error(source.path, "image.format", "is gzipped twice; once is expected");
    return decode_image({source.path, *unpacked});
  }
  if (starts_with(bytes, "\x89PNG\r\n\x1a\n")) {
    if (auto whole = check_png(source); !whole) return tl::unexpected(whole.error());
    return decode_stb(source);
  }
  if (starts_with(bytes, "\x76\x2f\x31\x01")) return decode_exr(source);
  if (starts_with(bytes, "PF") || starts_with(bytes, "Pf")) return decode_pfm(source);
  if (starts_with(bytes, "\xff\xd8\xff")) {
    if (auto whole = check_jpeg(source); !whole) return tl::unexpected(whole.error());
    return decode_stb(source);
  }
  if (is_run_length_bmp(bytes)) {
    const auto expanded = expand_bmp(source);
    if (!expanded) return tl::unexpected(expanded.error());
    return decode_stb({source.path, with_whole_palette(*expanded)});
  }
  if (starts_with(bytes, "BM")) return decode_stb({source.path, with_whole_palette(bytes)});
  if (starts_with(bytes, "#?") || is_named_tga(source.path)) {
    return decode_stb(source);
  }
  return file_error(source.path, "image.format",
                    "is in no known format; PNG, BMP, TGA, JPEG, HDR, PFM or EXR is expected");
}

Result<Image> load_image(const std::filesystem::path& path) {
  const auto bytes = read_file(path, "image");
  if (!bytes) return tl::unexpected(bytes.error());
  try {
    auto decoded = decode_image({path, *bytes});
    if (!decoded) return tl::unexpected(decoded.error());
    return std::move(decoded->image);
  } catch (const std::exception&) {
    return file_error(path, "image.memory",
                      "cannot be decoded: it needs more memory than there is, or its decoder fails");
  }
}

}  // namespace relievo
