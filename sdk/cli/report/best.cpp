/// What a sweep's rows say together: what is timed, what is worth its time (the non-dominated set), what is finite.
#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <tuple>

#include "report/sweep.hpp"

namespace relievo::cli {

void mark_best(std::vector<SweepRow>& rows) {
  using Place = std::tuple<std::string, double, std::string>;
  std::map<Place, std::vector<SweepRow*>> places;
  for (SweepRow& row : rows) {
    row.best = false;
    if (row.ratio > 0 && row.error.judged > 0) places[{row.map, row.angle, row.backend}].push_back(&row);
  }
  for (auto& [place, list] : places) {
    std::stable_sort(list.begin(), list.end(), [](const SweepRow* a, const SweepRow* b) {
      return std::pair(a->ratio, a->wrong_percent()) < std::pair(b->ratio, b->wrong_percent());
    });
    double least = 101;
    for (SweepRow* row : list) {
      row->best = row->wrong_percent() < least;
      least = std::min(least, row->wrong_percent());
    }
  }
}

bool Sweep::is_timed() const {
  return std::any_of(rows.begin(), rows.end(), [](const SweepRow& row) { return row.seconds >= 0; });
}

bool Sweep::has_ratios(const std::string& map) const {
  return std::any_of(rows.begin(), rows.end(), [&](const SweepRow& row) {
    return row.map == map && row.backend == backends.front() && row.ratio > 0;
  });
}

void check_finite(const Sweep& sweep, std::vector<Check>& checks) {
  if (sweep.rows.empty()) return;
  std::uint64_t found = 0;
  std::string where;
  for (const SweepRow& row : sweep.rows) {
    found += row.error.non_finite;
    if (row.error.non_finite > 0) where = fmt::format(" ({} on {} at {}°)", label(row.setting), row.map, row.angle);
  }
  checks.push_back({"rays with NaN or Inf in the sweep",
                    fmt::format("{} in {} rows{}", found, sweep.rows.size(), where), "0", found == 0});
}

}  // namespace relievo::cli
