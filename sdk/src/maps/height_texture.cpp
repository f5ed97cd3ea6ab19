/// The encodings of the axis `format` of the map `height`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "relievo/maps.hpp"

namespace relievo {

namespace {

std::vector<std::byte> alpha_texels(const std::vector<float>& heights) {
  std::vector<float> values(4 * heights.size(), 0.0f);
  for (std::size_t i = 0; i < heights.size(); ++i) values[4 * i + 3] = heights[i];
  std::vector<std::byte> bytes(values.size() * sizeof(float));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::vector<std::byte> red_green_texels(const std::vector<float>& heights) {
  std::vector<std::byte> bytes;
  bytes.reserve(2 * heights.size());
  for (const float height : heights) {
    const long quantised = std::lround(std::clamp(height, 0.0f, 1.0f) * 65535.0);
    bytes.push_back(static_cast<std::byte>(quantised >> 8));
    bytes.push_back(static_cast<std::byte>(quantised & 255));
  }
  return bytes;
}

}  // namespace

Result<Texture> height_texture(const MapData& height, std::string_view format) {
  Texture texture = map_texture(height);
  if (format == "red") return texture;
  if (format == "alpha") {
    texture.format = Format::rgba32_float;
    texture.data = {alpha_texels(height.texels.floats())};
  } else if (format == "red_green") {
    texture.format = Format::rg8_unorm;
    texture.data = {red_green_texels(height.texels.floats())};
  } else {
    return fail(ErrorCode::usage, "maps.height-format",
                fmt::format("height format '{}' is unknown; expected red, alpha or red_green", format));
  }
  texture.name = fmt::format("{} ({})", height.name, format);
  return texture;
}

}  // namespace relievo
