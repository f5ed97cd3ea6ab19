/// Error figures (docs/conventions.md): a technique's hits against the oracle's, and its pictures against the oracle's.
/// Every function here is thread-safe.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "relievo/image.hpp"
#include "relievo/oracle.hpp"

namespace relievo {

/// NaN where there is no whole.
inline double percent_of(std::uint64_t part, std::uint64_t whole) {
  return whole ? 100.0 * static_cast<double>(part) / static_cast<double>(whole)
               : std::numeric_limits<double>::quiet_NaN();
}

/// Whether all of its numbers are.
bool is_finite(const Hit& hit);

/// Nearest-rank quantiles over hits that are neither missed, false nor wrong-layer; NaN where there are none.
struct ErrorQuantiles {
  double p50 = std::numeric_limits<double>::quiet_NaN(), p99 = p50, max = p50;
};

struct ErrorFigures {
  std::uint64_t rays = 0;         ///< all rays given
  std::uint64_t ambiguous = 0;    ///< set apart: not counted below
  std::uint64_t judged = 0;       ///< rays − ambiguous − those on which the oracle itself is exhausted
  std::uint64_t missed = 0;       ///< oracle hits, technique says miss or outside
  std::uint64_t false_hit = 0;    ///< technique hits, oracle does not
  std::uint64_t wrong_layer = 0;  ///< both hit, more than 1 texel in uv or 0.02 in H apart
  std::uint64_t exhausted = 0;    ///< technique ran out of steps
  std::uint64_t non_finite = 0;   ///< of all rays: NaN in the answer (Hit::sanitized), NaN or Inf in what comes out
  ErrorQuantiles uv_texels;       ///< |Δuv| in texels (max norm over the axes)
  ErrorQuantiles height;          ///< |ΔH|
  double mean_steps = 0, mean_fetches = 0;

  /// Of the judged rays; NaN where there are none.
  double percent(std::uint64_t count) const { return percent_of(count, judged); }
  /// missed + false + wrong-layer, percent of judged rays.
  double wrong_percent() const { return percent(missed + false_hit + wrong_layer); }
};

/// Compares `measured` with `reference` ray by ray; both have the same length. width, height: the map's size in texels.
/// `inside` counts as a hit at t = 0 on both sides.
ErrorFigures compare_hits(std::span<const Hit> reference, std::span<const Hit> measured, int width, int height);

/// Two 8-bit RGBA images of the same size; alpha > 0 marks what was drawn.
struct ImageDifference {
  double within_percent = 100;  ///< pixels whose channels all differ by at most 1/255
  int largest = 0;              ///< largest difference of a channel, of 255
  double psnr = 0;              ///< dB over the colour channels; infinite when equal
  double mask_iou = 1;          ///< intersection over union of the drawn pixels; 1 when both are empty
};

/// Errors of the caller: sizes that differ are asserted.
ImageDifference compare_images(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);

/// The authors' viewing distance: 0.7 m from a monitor of 3840 pixels over 0.69 m.
inline constexpr double flip_pixels_per_degree = 67;

struct FlipDifference {
  double mean = 0;         ///< over all pixels, in [0,1]: 0 = no difference is seen
  std::vector<float> map;  ///< one a pixel, in [0,1]
};

/// FLIP: what an eye sees that flips between two pictures in place (Andersson, Nilsson, Akenine-Möller, Oskarsson,
/// Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG 2020; that for low dynamic range).
/// Two 8-bit sRGB-coded RGBA images of width·height pixels; alpha is not read. Symmetric; at least two pixels a degree.
/// Errors of the caller: sizes that differ and fewer pixels a degree are asserted.
FlipDifference flip(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height,
                    double pixels_per_degree = flip_pixels_per_degree);

struct PixelOffsets {
  std::uint64_t judged = 0;  ///< pixels that both pictures draw
  std::uint64_t lost = 0;    ///< of these, the ones whose surface point the reference shows nowhere
  ErrorQuantiles pixels;     ///< distance over the others

  /// NaN where no pixel is judged.
  double lost_percent() const { return percent_of(lost, judged); }
};

/// How far the features of a picture lie from where the reference has them, in pixels. Both are pictures of one scene
/// by one camera, drawn with Aov::uv: which surface point each pixel shows. The offset of a pixel is its distance to
/// the place where the reference shows the same (u,v), between pixels by linear interpolation; of several places, to
/// the nearest. What the reference hides lies at the edge that hides it, for there its picture jumps across those
/// (u,v).
///
/// Why not from the colours: block matching finds no motion where the shading is even and a wrong one along edges,
/// while the hits say it for every pixel. Why not Δ(u,v) times a derivative: the derivative of the relief's picture has
/// no value at occlusions, and the base surface's says nothing of slopes; searching the reference needs neither.
///
/// At outlines, where no three pixels are around a point, what a pixel shows nearly (half a pixel by the step to its
/// neighbours) counts as shown there.
///
/// (u,v) count modulo 1. A step from pixel to pixel of more than a quarter of the texture is a seam, and shows nothing.
/// Errors of the caller: sizes that differ or other than 4 channels are asserted.
PixelOffsets pixel_offsets(const Image& reference, const Image& measured);

/// Pixels that `image` leaves empty although `reference` draws them and all pixels within `margin` around them: cracks.
std::uint64_t count_cracks(std::span<const std::uint8_t> image, std::span<const std::uint8_t> reference, int width,
                           int height, int margin = 2);

}  // namespace relievo
