#include "report/heat.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "relievo/image.hpp"

namespace relievo::cli {

namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr int gap = 4;
constexpr float least_texels = 1e-4f;
constexpr Color grey = {150, 150, 150}, red = {214, 40, 40}, white = {255, 255, 255};

/// Dark violet, blue, green, yellow: brighter all the way, so that it reads in grey as well.
Color ramp(float value) {
  constexpr std::array<Color, 5> anchors = {
      {{40, 10, 70}, {58, 82, 139}, {32, 144, 140}, {94, 201, 97}, {253, 231, 37}}};
  float at = std::clamp(value, 0.0f, 1.0f) * (anchors.size() - 1);
  std::size_t below = std::min<std::size_t>(static_cast<std::size_t>(at), anchors.size() - 2);
  Color color{};
  for (std::size_t c = 0; c < color.size(); ++c)
    color[c] = static_cast<std::uint8_t>(
        std::lround(std::lerp(float(anchors[below][c]), float(anchors[below + 1][c]), at - static_cast<float>(below))));
  return color;
}

Color steps_color(float steps, float most) {
  if (std::isnan(steps)) return grey;
  return ramp(std::log2(std::max(steps, 1.0f)) / std::log2(most));
}

Color error_color(float texels) {
  if (std::isnan(texels)) return grey;
  if (std::isinf(texels)) return red;
  return ramp(1 - std::log(std::max(texels, least_texels)) / std::log(least_texels));
}

}  // namespace

float most_steps(const std::vector<HeatMap>& heat) {
  float most = 2;
  for (const HeatMap& map : heat) {
    for (float steps : map.steps) {
      if (steps > most) most = steps;
    }
  }
  return most;
}

HeatPicture draw_heat(const HeatMap& heat, float most) {
  HeatPicture picture{2 * heat.size + gap, heat.size, {}};
  auto put = [&](const Color& color) { picture.pixels.insert(picture.pixels.end(), color.begin(), color.end()); };
  for (int y = 0; y < heat.size; ++y) {
    auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(heat.size);
    auto size = static_cast<std::size_t>(heat.size);
    for (std::size_t x = 0; x < size; ++x) put(steps_color(heat.steps[row + x], most));
    for (int x = 0; x < gap; ++x) put(white);
    for (std::size_t x = 0; x < size; ++x) put(error_color(heat.texels[row + x]));
  }
  return picture;
}

Status write_heat(const Sweep& sweep, const std::filesystem::path& folder) {
  float most = most_steps(sweep.heat);
  for (const HeatMap& heat : sweep.heat) {
    HeatPicture picture = draw_heat(heat, most);
    std::filesystem::path file = folder / fmt::format("heat-{}.png", heat.technique);
    if (Status status = write_png(file, picture.width, picture.height, 3, picture.pixels); !status) return status;
  }
  return {};
}

}  // namespace relievo::cli
