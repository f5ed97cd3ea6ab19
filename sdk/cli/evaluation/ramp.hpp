/// One colour scale for all that is drawn as colours.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace relievo::cli {

using RampColor = std::array<std::uint8_t, 3>;

/// Dark violet at 0, blue, green, yellow at 1: brighter all the way, so that it reads in grey as well.
inline RampColor ramp(float value) {
  constexpr std::array<RampColor, 5> anchors = {
      {{40, 10, 70}, {58, 82, 139}, {32, 144, 140}, {94, 201, 97}, {253, 231, 37}}};
  float at = std::clamp(value, 0.0f, 1.0f) * (anchors.size() - 1);
  std::size_t below = std::min<std::size_t>(static_cast<std::size_t>(at), anchors.size() - 2);
  RampColor color{};
  for (std::size_t c = 0; c < color.size(); ++c)
    color[c] = static_cast<std::uint8_t>(
        std::lround(std::lerp(float(anchors[below][c]), float(anchors[below + 1][c]), at - static_cast<float>(below))));
  return color;
}

}  // namespace relievo::cli
