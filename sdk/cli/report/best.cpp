/// What is timed, and the non-dominated set: what is worth its time.
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

bool Sweep::is_timed(const std::string& map) const {
  return std::any_of(rows.begin(), rows.end(), [&](const SweepRow& row) {
    return row.map == map && row.backend == backends.front() && row.ratio > 0;
  });
}

}  // namespace relievo::cli
