#include "measure/flip_color.hpp"

#include <algorithm>
#include <cmath>

namespace relievo::flip_color {

namespace {

using Matrix = std::array<Color, 3>;  // rows

/// From the chromaticities of ITU-R BT.709 and its white D65 = (0.3127, 0.3290).
constexpr Matrix xyz_of_rgb = {{{0.41239080f, 0.35758434f, 0.18048079f},
                                {0.21263901f, 0.71516868f, 0.07219232f},
                                {0.01933082f, 0.11919478f, 0.95053215f}}};
constexpr Matrix rgb_of_xyz = {{{3.24096994f, -1.53738318f, -0.49861076f},
                                {-0.96924364f, 1.87596750f, 0.04155506f},
                                {0.05563008f, -0.20397696f, 1.05697151f}}};

constexpr Color multiply(const Matrix& m, const Color& c) {
  Color result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = m[i][0] * c[0] + m[i][1] * c[1] + m[i][2] * c[2];
  return result;
}

constexpr Color white = multiply(xyz_of_rgb, {1, 1, 1});

/// X, Y, Z as shares of the white's.
Color relative_xyz(const Color& rgb) {
  Color xyz = multiply(xyz_of_rgb, rgb);
  for (std::size_t i = 0; i < 3; ++i) xyz[i] /= white[i];
  return xyz;
}

float lab_curve(float t) {
  constexpr float delta = 6.0f / 29.0f;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29.0f;
}

std::array<float, 256> linear_of_codes() {
  std::array<float, 256> table{};
  for (std::size_t code = 0; code < table.size(); ++code) {
    double c = static_cast<double>(code) / 255.0;
    table[code] = static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return table;
}

}  // namespace

float linear(std::uint8_t code) {
  static const std::array<float, 256> table = linear_of_codes();
  return table[code];
}

Color to_ycxcz(const Color& rgb) {
  Color xyz = relative_xyz(rgb);
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

Color to_linear_rgb(const Color& c) {
  float y = (c[0] + 16) / 116;
  Color rgb = multiply(rgb_of_xyz, {white[0] * (y + c[1] / 500), white[1] * y, white[2] * (y - c[2] / 200)});
  for (float& channel : rgb) channel = std::clamp(channel, 0.0f, 1.0f);
  return rgb;
}

Color to_hunt_lab(const Color& rgb) {
  Color xyz = relative_xyz(rgb);
  float x = lab_curve(xyz[0]), y = lab_curve(xyz[1]), z = lab_curve(xyz[2]);
  float lightness = 116 * y - 16, fade = 0.01f * lightness;
  return {lightness, fade * 500 * (x - y), fade * 200 * (y - z)};
}

float hyab(const Color& a, const Color& b) {
  float da = a[1] - b[1], db = a[2] - b[2];
  return std::abs(a[0] - b[0]) + std::sqrt(da * da + db * db);
}

}  // namespace relievo::flip_color
