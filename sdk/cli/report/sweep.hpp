/// Speed against error: each technique over a range of step counts, beside relief mapping in the same run.
#pragma once

#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

/// One technique with one step count over the rays of the first height map at an angle.
struct SweepPoint {
  std::string technique, filter;
  double angle = 0;  ///< degrees above the base plane
  std::string loop;  ///< the loop that is varied; empty: the technique has none
  int count = 0;     ///< its value
  double wrong_percent = 0;
  double resolution = 0;  ///< what one judged ray is, percent: 0 wrong means less than that
  double seconds = -1;    ///< median; −1 without timestamps
  double ratio = -1;      ///< seconds over those of relief mapping, 100 + 7 steps, hardware filter, in the same run
};

struct Sweep {
  std::string case_name, backend;  ///< empty when nothing was swept
  int image = 0;                   ///< rays: image²
  std::vector<double> angles = {20, 8};
  std::vector<SweepPoint> points;
};

/// Runs the sweep on `backend` over the first ray case of `input`, with `image`² rays.
Result<Sweep> run_sweep(const EvaluationInput& input, const std::string& backend, int image);

nlohmann::json to_json(const Sweep& sweep);

}  // namespace relievo::cli
