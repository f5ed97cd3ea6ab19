/// The claims of a conformance run and the figures that they stand on.
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

bool is_backend(const Evaluation& evaluation, std::string_view name) {
  return std::any_of(evaluation.backends.begin(), evaluation.backends.end(),
                     [&](const EvaluatedBackend& b) { return b.info.name == name; });
}

namespace {

constexpr double rays_equal_percent = 99.99;    // of non-ambiguous rays, between two backends
constexpr double pixels_within_percent = 99.9;  // of pixels, within 1/255, between two backends
constexpr double silhouette_iou = 0.99;         // prisms against the finely displaced mesh
constexpr double offset_pixels = 0.1;           // p99 of a technique that always finds the first hit

/// What every row's figure is to keep.
struct Bound {
  enum Side { least, most } side;
  double value;
};

template <class Rows, class Value>
void check_bound(const Rows& rows, const std::string& name, Bound bound, const char* unit, Value value,
                 std::vector<Check>& checks) {
  const double sign = bound.side == Bound::least ? 1 : -1;
  double worst = sign * 1e300;
  std::string where;
  std::size_t count = 0;
  for (const auto& row : rows) {
    auto [relevant, figure, label] = value(row);
    if (!relevant) continue;
    ++count;
    if (std::isnan(worst) || sign * figure >= sign * worst) continue;  // nothing is worse than no figure
    worst = figure;
    where = label;
  }
  if (count == 0) return;
  checks.push_back({name, fmt::format("{:.5g}{} at worst of {} ({})", worst, unit, count, where),
                    fmt::format("at {} {}{}", bound.side == Bound::least ? "least" : "most", bound.value, unit),
                    sign * worst >= sign * bound.value});
}

void check_none(const std::string& name, std::uint64_t found, std::size_t of, const std::string& where,
                std::vector<Check>& checks) {
  if (of == 0) return;
  checks.push_back(
      {name, fmt::format("{} in {} cases{}", found, of, where.empty() ? "" : " (" + where + ")"), "0", found == 0});
}

}  // namespace

bool holds_silhouette(const Registry& registry, const std::string& technique) {
  auto found = registry.techniques.find(technique);
  return found != registry.techniques.end() && found->second.first_hit != FirstHit::never;
}

bool always_finds_first_hit(const Registry& registry, const std::string& technique) {
  auto found = registry.techniques.find(technique);
  return found != registry.techniques.end() && found->second.first_hit == FirstHit::always;
}

namespace {

/// A smaller budget than the technique's own may run out, and no search goes further than 1024 texture widths.
bool may_exhaust(const EvaluationInput& input, const RayRow& row) {
  constexpr double furthest = 1000, degree = 3.14159265358979323846 / 180;
  const TechniqueDescriptor& technique = input.registry->techniques.at(row.technique);
  const auto is_set = [&](const Parameter& p) {
    return p.is_loop && input.values.contains(row.technique + "." + p.name);
  };
  const auto is_far = [&](const RayCase& c) {
    return c.name == row.case_name && c.scale > furthest * std::tan(row.angle * degree);
  };
  return std::any_of(technique.parameters.begin(), technique.parameters.end(), is_set) ||
         std::any_of(input.ray_cases.begin(), input.ray_cases.end(), is_far);
}

/// Of techniques that claim to find the first hit always, on the bilinear surface.
void check_first_hits(const EvaluationInput& input, const std::vector<RayRow>& rows, std::vector<Check>& checks) {
  std::uint64_t found = 0;
  std::size_t count = 0;
  std::string where;
  for (const RayRow& row : rows) {
    const ErrorFigures& e = row.error;
    if (row.filter != "exact" || e.judged == 0 || !always_finds_first_hit(*input.registry, row.technique)) continue;
    ++count;
    const std::uint64_t here = e.missed + e.false_hit + e.wrong_layer + (may_exhaust(input, row) ? 0 : e.exhausted);
    found += here;
    if (here > 0) where = fmt::format("{} on {} at {}°, {}", row.technique, row.case_name, row.angle, row.backend);
  }
  check_none("rays missed, falsely hit, on a wrong layer or exhausted where first hits are certain", found, count,
             where, checks);
}

}  // namespace

void judge(const EvaluationInput& input, Evaluation& evaluation) {
  using Judged = std::tuple<bool, double, std::string>;
  std::vector<Check>& checks = evaluation.checks;
  check_bound(
      evaluation.ray_agreements, fmt::format("rays equal between backends, t within {} ulp, filter exact", equal_ulps),
      {Bound::least, rays_equal_percent}, " %",
      [](const RayAgreement& r) {
        return Judged{r.filter == "exact" && r.judged > 0, r.equal_percent,
                      fmt::format("{} on {} at {}°", r.technique, r.case_name, r.angle)};
      },
      checks);
  check_first_hits(input, evaluation.rays, checks);
  check_bound(
      evaluation.picture_agreements, "pixels within 1/255 between backends", {Bound::least, pixels_within_percent},
      " %",
      [&](const PictureAgreement& p) {
        return Judged{is_backend(evaluation, p.right), p.difference.within_percent,
                      fmt::format("{} {} of {}", p.stage, p.technique, p.scene)};
      },
      checks);
  check_bound(
      evaluation.picture_agreements, "prism silhouette against the displaced mesh, IoU", {Bound::least, silhouette_iou},
      "",
      [&](const PictureAgreement& p) {
        bool closed = std::any_of(input.scenes.begin(), input.scenes.end(), [&](const auto& s) {
          return s.first == p.scene && s.second.scene.mesh.kind != MeshKind::plane;
        });
        return Judged{
            closed && p.stage == "prism" && p.right == "vertex" && holds_silhouette(*input.registry, p.technique),
            p.difference.mask_iou, fmt::format("{} of {} on {}", p.technique, p.scene, p.left)};
      },
      checks);
  check_bound(
      evaluation.picture_agreements, "pixel offset against the oracle's picture where first hits are certain, p99",
      {Bound::most, offset_pixels}, " px",
      [&](const PictureAgreement& p) {
        const bool is_drawn = p.offsets && (p.offsets->judged > 0 || p.difference.mask_iou < 1);
        return Judged{is_drawn && always_finds_first_hit(*input.registry, p.technique),
                      p.offsets ? p.offsets->pixels.p99 : 0, fmt::format("{} {} of {}", p.stage, p.technique, p.scene)};
      },
      checks);
  std::uint64_t cracks = 0, non_finite = 0, changing = 0;
  std::string where;
  for (const CrackRow& row : evaluation.cracks) {
    cracks += row.cracks;
    if (row.cracks > 0) where = fmt::format("{} of {} on {}, seed {}", row.technique, row.scene, row.backend, row.seed);
  }
  for (const RayRow& row : evaluation.rays) non_finite += row.error.non_finite;
  for (const PictureRow& row : evaluation.pictures) changing += !row.repeatable;
  check_none("crack pixels under random vertex orders", cracks, evaluation.cracks.size(), where, checks);
  if (input.repeats > 1)
    check_none("pictures that change from run to run", changing, evaluation.pictures.size(), "", checks);
  check_none("rays with NaN or Inf", non_finite, evaluation.rays.size(), "", checks);
  checks.push_back({"validation and debug messages",
                    fmt::format("{}{}", evaluation.messages.size(),
                                evaluation.messages.empty() ? "" : ": " + evaluation.messages.front()),
                    "0", evaluation.messages.empty()});
}

}  // namespace relievo::cli
