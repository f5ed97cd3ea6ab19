#include <fmt/format.h>

#include "evaluation/fuzz.hpp"
#include "evaluation/hard_run.hpp"

namespace relievo::cli {

namespace {

std::string describe(const Ray& r, const Hit& h) {
  return fmt::format(
      "ray {:.17g},{:.17g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}: status {} at t {:.9g}, ({:.9g}, {:.9g}, "
      "{:.9g})",
      r.u, r.v, r.h, r.du, r.dv, r.dh, r.t_max, static_cast<int>(h.status), h.t, h.u, h.v, h.h);
}

}  // namespace

void judge_fuzz(const FuzzRound& round, std::span<const Hit> hits, std::span<const Hit> truth, FuzzRow& row,
                std::vector<std::string>& findings) {
  const std::uint64_t before[] = {row.non_finite, row.bad_status};
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    row.hits += hit.status == HitStatus::hit || hit.status == HitStatus::inside;
    row.exhausted += hit.status == HitStatus::exhausted;
    row.sanitized += hit.sanitized;
    if (!is_finite(hit) && ++row.non_finite == before[0] + 1)
      findings.push_back("NaN or Inf: " + describe(round.rays[i], hit));
    const int status = static_cast<int>(hit.status);
    if ((status < 0 || status > static_cast<int>(HitStatus::outside)) && ++row.bad_status == before[1] + 1)
      findings.push_back("no such status: " + describe(round.rays[i], hit));
  }
  if (truth.empty()) return;
  const HardRow judged = judge_hard_rays(round.map, std::span(round.rays).first(truth.size()), truth,
                                         hits.first(truth.size()), FirstHit::always, true);
  row.judged += judged.error.judged;
  row.unsound += judged.wrong() + judged.error.missed + judged.error.false_hit;
  if (judged.fault.empty() || !judged.example) return;
  const HardExample& e = *judged.example;
  findings.push_back(
      fmt::format("{} of {} rays, first {}; the oracle says {} at t {:.9g}, ({:.9g}, {:.9g}, {:.9g}); {}x{} map, {}",
                  judged.fault, judged.error.judged, describe(e.ray, e.found), to_string(e.truth.status), e.truth.t,
                  e.truth.u, e.truth.v, e.truth.h, round.map.width, round.map.height, to_string(round.map.address)));
}

}  // namespace relievo::cli
