#include <algorithm>
#include <cmath>
#include <vector>

#include "measure/quantiles.hpp"
#include "relievo/measure.hpp"

namespace relievo {

bool is_finite(const Hit& hit) {
  return std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v) && std::isfinite(hit.h);
}

namespace {

/// Beyond these two hits are on different layers of the relief (design.md §5).
constexpr double wrong_layer_texels = 1.0;
constexpr double wrong_layer_height = 0.02;

bool is_hit(const Hit& hit) {
  return hit.status == HitStatus::hit || hit.status == HitStatus::inside;
}

struct Deviations {
  std::vector<double> uv_texels, height;
};

void judge(const Hit& reference, const Hit& measured, int width, int height, ErrorFigures& figures,
           Deviations& deviations) {
  ++figures.judged;
  if (measured.status == HitStatus::exhausted) {
    ++figures.exhausted;
  } else if (is_hit(reference) && !is_hit(measured)) {
    ++figures.missed;
  } else if (!is_hit(reference) && is_hit(measured)) {
    ++figures.false_hit;
  } else if (is_hit(reference)) {
    const double uv = std::max(std::abs(measured.u - reference.u) * width, std::abs(measured.v - reference.v) * height);
    const double h = std::abs(measured.h - reference.h);
    // Written so that a hit at NaN is nowhere near.
    const bool same_layer = is_finite(measured) && uv <= wrong_layer_texels && h <= wrong_layer_height;
    if (!same_layer) {
      ++figures.wrong_layer;
      return;
    }
    deviations.uv_texels.push_back(uv);
    deviations.height.push_back(h);
  }
}

}  // namespace

ErrorFigures compare_hits(std::span<const Hit> reference, std::span<const Hit> measured, int width, int height) {
  ErrorFigures figures;
  Deviations deviations;
  figures.rays = std::min(reference.size(), measured.size());
  double steps = 0, fetches = 0;
  for (std::size_t i = 0; i < figures.rays; ++i) {
    steps += measured[i].steps;
    fetches += measured[i].fetches;
    figures.non_finite += measured[i].sanitized || !is_finite(measured[i]);
    if (reference[i].ambiguous)
      ++figures.ambiguous;
    else if (reference[i].status != HitStatus::exhausted)
      judge(reference[i], measured[i], width, height, figures, deviations);
  }
  figures.uv_texels = quantiles(deviations.uv_texels);
  figures.height = quantiles(deviations.height);
  if (figures.rays > 0) {
    figures.mean_steps = steps / static_cast<double>(figures.rays);
    figures.mean_fetches = fetches / static_cast<double>(figures.rays);
  }
  return figures;
}

}  // namespace relievo
