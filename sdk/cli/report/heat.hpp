/// Pictures of where a technique takes steps and where it is wrong.
#pragma once

#include <cstdint>
#include <vector>

#include "report/sweep.hpp"

namespace relievo::cli {

/// RGB, 2·size + gap pixels wide and size high: steps on the left, from dark for one to bright for `most_steps`,
/// logarithmic; |Δuv| on the right, from dark for 10⁻⁴ texels to bright for one, red where the ray is wrong. What is
/// not judged is grey.
struct HeatPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};
HeatPicture draw_heat(const HeatMap& heat, float most_steps);

/// The most steps of any judged ray of all maps, so that their pictures compare; at least 2.
float most_steps(const std::vector<HeatMap>& heat);

/// Writes heat-<technique>.png for each into `folder`.
Status write_heat(const Sweep& sweep, const std::filesystem::path& folder);

}  // namespace relievo::cli
