#include <fmt/format.h>
#include <cmath>

#include "evaluation/hard_run.hpp"

namespace relievo::cli {

namespace {

/// The ambiguity of the oracle: less deep below the surface, float and double may disagree on which side a ray starts.
constexpr double certain_depth = 1e-5;

/// Of a ray that `error`, its own figures, finds nothing wrong with.
bool is_inside_missed(const HeightMap& map, const Ray& ray, const Hit& truth, const Hit& found,
                      const ErrorFigures& error) {
  if (truth.ambiguous || truth.status != HitStatus::inside) return false;
  if (error.exhausted + error.missed + error.wrong_layer > 0) return false;  // counted there
  if (sample_height(map, ray.u, ray.v) - ray.h <= certain_depth) return false;
  return found.status != HitStatus::inside || found.t != 0;
}

HardRow count(const HeightMap& map, std::span<const Ray> rays, std::span<const Hit> truth, std::span<const Hit> hits) {
  HardRow row;
  row.error = compare_hits(truth, hits, map.width, map.height);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (truth[i].status != HitStatus::inside) continue;
    const ErrorFigures one = compare_hits(truth.subspan(i, 1), hits.subspan(i, 1), map.width, map.height);
    row.not_inside += is_inside_missed(map, rays[i], truth[i], hits[i], one);
  }
  return row;
}

/// Shorter than this in u or v, what a ray covers of a clip map's domain is rounding of its numbers in float.
constexpr double certain_length = 1e-6;

/// How far the ray runs in u and v within the domain; negative when it passes by.
double length_in_domain(const Ray& ray) {
  double begin = 0, end = ray.t_max;
  for (const auto& [origin, direction] : {std::pair(ray.u, ray.du), std::pair(ray.v, ray.dv)}) {
    if (direction == 0) continue;
    const double to_0 = -origin / direction, to_1 = (1 - origin) / direction;
    begin = std::max(begin, std::min(to_0, to_1));
    end = std::min(end, std::max(to_0, to_1));
  }
  return (end - begin) * std::max(std::abs(ray.du), std::abs(ray.dv));
}

}  // namespace

void mark_domain_grazes(const HeightMap& map, std::span<const Ray> rays, std::span<Hit> truth) {
  if (map.address != AddressMode::clip) return;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (std::abs(length_in_domain(rays[i])) < certain_length && (rays[i].du != 0 || rays[i].dv != 0))
      truth[i].ambiguous = true;
  }
}

std::string fault_of(const HardRow& row, FirstHit claim, bool may_exhaust) {
  std::vector<std::string> faults;
  const auto add = [&](std::uint64_t found, const char* what) {
    if (found > 0) faults.push_back(fmt::format("{} {}", found, what));
  };
  if (claim == FirstHit::always) {
    add(row.wrong(), "wrong");
    add(row.error.missed, "missed");
    add(row.error.false_hit, "false");
    if (!may_exhaust) add(row.error.exhausted, "exhausted");
  }
  add(row.error.non_finite, "NaN or Inf");
  return fmt::format("{}", fmt::join(faults, ", "));
}

HardRow judge_hard_rays(const HeightMap& map, std::span<const Ray> rays, std::span<const Hit> truth,
                        std::span<const Hit> hits, FirstHit claim, bool may_exhaust) {
  HardRow row = count(map, rays, truth, hits);
  row.fault = fault_of(row, claim, may_exhaust);
  for (std::size_t i = 0; i < rays.size() && !row.fault.empty() && !row.example; ++i) {
    const HardRow one = count(map, rays.subspan(i, 1), truth.subspan(i, 1), hits.subspan(i, 1));
    if (!fault_of(one, claim, may_exhaust).empty()) row.example = HardExample{rays[i], truth[i], hits[i]};
  }
  return row;
}

std::uint64_t HardResult::faults() const {
  std::uint64_t count = 0;
  for (const HardRow& row : rows) count += !row.fault.empty();
  return count;
}

}  // namespace relievo::cli
