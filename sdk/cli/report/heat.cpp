#include "report/heat.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "evaluation/ramp.hpp"
#include "relievo/image.hpp"

namespace relievo::cli {

namespace {

using Color = RampColor;

constexpr int gap = 4;
constexpr float least_texels = 1e-4f;
constexpr Color grey = {150, 150, 150}, red = {214, 40, 40}, white = {255, 255, 255};

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
