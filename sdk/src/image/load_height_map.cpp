#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "files/whole_file.hpp"
#include "image/array.hpp"
#include "image/decode.hpp"
#include "relievo/height_map.hpp"

namespace relievo {

namespace {

/// Brings values of any range to [0,1]; a constant becomes 0.
class Normalizer {
 public:
  void include(double value) {
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
  }
  bool is_unit() const { return min_ >= 0 && max_ <= 1; }
  float operator()(double value) const {
    // Halved first: max − min may be beyond the largest double.
    const double range = 0.5 * max_ - 0.5 * min_;
    return range > 0 ? static_cast<float>(std::clamp((0.5 * value - 0.5 * min_) / range, 0.0, 1.0)) : 0.0f;
  }

 private:
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
};

tl::unexpected<Error> non_finite_error(const std::filesystem::path& path, int i, int j, double value) {
  return file_error(
      path, "image.non-finite",
      fmt::format("has {} at texel ({}, {}); a finite height is expected", std::isnan(value) ? "NaN" : "Inf", i, j));
}

/// Colour is its first channel where all are equal throughout, else Rec. 709 luminance; without colour the first
/// channel.
std::vector<float> to_grey(DecodedImage&& decoded) {
  Image& image = decoded.image;
  if (image.channels == 1) return std::move(image.pixels);
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t count = image.pixels.size() / channels;
  const float* pixels = image.pixels.data();
  bool coloured = false;
  for (std::size_t i = 0; decoded.is_colour && !coloured && i < count; ++i) {
    const float* p = pixels + i * channels;
    coloured = p[0] != p[1] || p[0] != p[2];
  }
  std::vector<float> grey(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* p = pixels + i * channels;
    grey[i] = coloured ? static_cast<float>(0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) : p[0];
  }
  return grey;
}

Result<HeightMap> from_image(const std::filesystem::path& path, DecodedImage&& decoded) {
  HeightMap map;
  map.width = decoded.image.width;
  map.height = decoded.image.height;
  map.texels = to_grey(std::move(decoded));
  Normalizer normalize;
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      if (!std::isfinite(map.at(i, j))) return non_finite_error(path, i, j, map.at(i, j));
      normalize.include(map.at(i, j));
    }
  }
  if (!normalize.is_unit()) std::transform(map.texels.begin(), map.texels.end(), map.texels.begin(), normalize);
  return map;
}

Result<HeightMap> from_array(const std::filesystem::path& path, const NumberArray& array) {
  HeightMap map;
  map.width = array.columns;
  map.height = array.rows;
  Normalizer normalize;
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      const double value = array.at(j, i);
      if (!std::isfinite(value)) return non_finite_error(path, i, j, value);
      normalize.include(value);
    }
  }
  const bool as_is = !array.is_integer() && normalize.is_unit();
  map.texels.reserve(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
  for (int j = 0; j < map.height; ++j) {
    for (int i = 0; i < map.width; ++i) {
      const double value = array.at(j, i);
      map.texels.push_back(as_is ? static_cast<float>(value) : normalize(value));
    }
  }
  return map;
}

Result<HeightMap> decode(const ImageSource& source) {
  if (is_npy(source.bytes) || is_zip(source.bytes)) {
    const auto array = is_npy(source.bytes) ? decode_npy(source) : decode_npz(source);
    if (!array) return tl::unexpected(array.error());
    return from_array(source.path, *array);
  }
  auto decoded = decode_image(source);
  if (!decoded) return tl::unexpected(decoded.error());
  return from_image(source.path, std::move(*decoded));
}

}  // namespace

Result<HeightMap> decode_height_map(const ImageSource& source) {
  try {
    return decode(source);
  } catch (const std::exception&) {
    return file_error(source.path, "image.memory",
                      "cannot be decoded: it needs more memory than there is, or its decoder fails");
  }
}

Result<HeightMap> load_height_map(const std::filesystem::path& path) {
  const auto bytes = read_file(path, "image");
  if (!bytes) return tl::unexpected(bytes.error());
  return decode_height_map({path, *bytes});
}

}  // namespace relievo
