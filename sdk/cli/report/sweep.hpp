/// Speed against error: every technique with several counts of each of its loops, on every map, at every angle, with
/// both filters, on the first backend; and some of the maps on every backend.
#pragma once

#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

/// A technique as it is, or with one of its loops at another count.
struct Setting {
  std::string technique;
  HeightFilter filter = HeightFilter::exact;
  std::string loop;  ///< the loop that is varied; empty: all have the values of the descriptor and of `--set`
  int count = 0;     ///< its value
};

/// One setting over the rays of a map at an angle.
struct SweepRow {
  std::string map, backend;
  double angle = 0;  ///< degrees above the base plane
  Setting setting;
  ErrorFigures error;
  double seconds = -1;  ///< median of the repeats; −1: not timed
  double spread = -1;   ///< (slowest − fastest) / median of the repeats
  double ratio = -1;    ///< median over the repeats of the time over the reference's median time in the same round
  bool best = false;    ///< every faster row of its map, angle and backend is more often wrong

  /// A ray whose budget runs out is wrong too, here.
  double wrong_percent() const { return error.wrong_percent() + error.percent(error.exhausted); }
};

/// What a height map's traced maps take.
struct MapCost {
  std::string height, map;
  int width = 0, height_texels = 0;  ///< of the height map
  std::size_t bytes = 0;             ///< as a texture
  double bake_seconds = -1;          ///< wall time of compiling, running and reading back; −1: given, not baked
};

/// A technique's status and steps on the first map, ray by ray, to look at.
struct HeatMap {
  std::string technique;
  int size = 0;               ///< rays a side
  std::vector<float> steps;   ///< a ray; NaN where the ray is not judged
  std::vector<float> texels;  ///< |Δuv|, infinite where the ray is wrong; NaN where it is not judged
};

/// The first map at the first angle once more, after the rest of that backend's sweep: how far time ratios can be
/// trusted.
struct Rerun {
  std::size_t rows = 0;
  double median = 0, p90 = 0, worst = 0;  ///< of |second ratio / first − 1|
};

struct SweepPlan {
  std::vector<double> angles = {60, 20, 8, 2};
  std::vector<double> factors = {0.25, 0.5, 1, 2, 4};  ///< of a loop's default count
  std::vector<int> budgets = {16, 64, 256};            ///< of a loop that is only a bound
  int image = 128, timed_image = 128;                  ///< rays whose errors are counted: image²; timed: timed_image²
  int repeats = 3;
  bool times_all = true;           ///< else only the first map is timed, with techniques at their own counts
  std::size_t maps_elsewhere = 0;  ///< of the maps, how many backends after the first sweep
};

struct Sweep {
  SweepPlan plan;
  std::vector<std::string> maps, backends;
  std::string reference;  ///< what ratios are to; empty when there is no such technique
  std::vector<SweepRow> rows;
  std::map<std::string, double> defaults;  ///< "technique.loop" → the count that rows without a loop have
  std::vector<MapCost> costs;
  std::vector<HeatMap> heat;
  double heat_angle = 0;
  Rerun rerun;
  std::vector<NotRun> not_run;
  double seconds = 0;  ///< wall time of it all

  bool is_timed() const;  ///< whether any row is
  /// Whether times of a map on the first backend are held against the reference.
  bool has_ratios(const std::string& map) const;
};

/// All settings of the techniques of `input`, technique by technique. A loop whose default is in the hundreds is a
/// bound that few rays reach: there the plan's budgets are tried, where it begins to cut.
Result<std::vector<Setting>> make_settings(const EvaluationInput& input, const SweepPlan& plan);

/// Runs the sweep over all ray cases of `input`. A backend that cannot be opened becomes a NotRun.
Result<Sweep> run_sweep(const EvaluationInput& input, const SweepPlan& plan);

/// Marks the rows that no other is at once as fast and as right as, for each map, angle and backend.
void mark_best(std::vector<SweepRow>& rows);

/// Adds the claim that no ray of the sweep has NaN or Inf.
void check_finite(const Sweep& sweep, std::vector<Check>& checks);

nlohmann::json to_json(const Sweep& sweep);

/// Every row with all its figures, one line each after a header.
std::string sweep_csv(const Sweep& sweep);

/// "relief, linear_steps = 400"
std::string label(const Setting& setting);

}  // namespace relievo::cli
