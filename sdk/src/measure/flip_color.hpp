/// The colour spaces of FLIP (Andersson et al. 2020): sRGB, YCxCz for filtering, L*a*b* for distances.
#pragma once

#include <array>
#include <cstdint>

namespace relievo::flip_color {

/// R, G, B linear in [0,1]; or Y, Cx, Cz; or L*, a*, b*.
using Color = std::array<float, 3>;

/// Linear light of an 8-bit sRGB code (IEC 61966-2-1).
float linear(std::uint8_t code);

/// The linear opponent space that the contrast sensitivity filters work in; Y is 0 for black − 16, 100 for white.
Color to_ycxcz(const Color& rgb);

/// Clamped to [0,1], as a display clamps it.
Color to_linear_rgb(const Color& ycxcz);

/// CIE L*a*b* with a* and b* faded where it is dark: the Hunt effect.
Color to_hunt_lab(const Color& rgb);

/// The distance for large differences: |ΔL*| plus the Euclidean distance of (a*, b*).
float hyab(const Color& a, const Color& b);

}  // namespace relievo::flip_color
