/// What `conform` judges and `report` shows: every technique in every stage on every backend, against the oracle.
#pragma once

#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common.hpp"
#include "relievo/maps.hpp"
#include "relievo/measure.hpp"

namespace relievo::cli {

/// A height map to trace rays against, seen at several angles.
struct RayCase {
  std::string name;  ///< of the file, without folder and extension
  HeightMap height;
  double scale = 0.1;                        ///< height of the lid in texture widths
  std::vector<double> angles = {60, 20, 8};  ///< degrees above the base plane
};

/// Baked maps, kept for all rays and pictures of one height map on one backend, or on all.
class BakedMaps {
 public:
  /// `shared`: what one backend bakes serves all.
  explicit BakedMaps(bool shared = false) : shared_(shared) {}
  /// `values`: what the maps are baked with; where their scales are not the descriptors' own, the maps are others.
  MapSet& of(const Registry& registry, const HeightMap& height, const std::string& backend,
             const std::map<std::string, double>& values);

 private:
  bool shared_;
  std::map<std::string, MapSet> sets_;
};

/// What a part of the work took.
struct Phase {
  std::string name;
  double seconds = 0, processor_seconds = 0;  ///< by the wall's clock, and of all threads
};

/// Times one part after another.
class PhaseClock {
 public:
  PhaseClock();
  /// What has passed since the last call, or since the start, was `name`; parts of one name are added up.
  void end(const std::string& name);
  const std::vector<Phase>& phases() const { return phases_; }

 private:
  std::vector<Phase> phases_;
  double seconds_, processor_seconds_;
};

struct EvaluationInput {
  const Registry* registry = nullptr;
  std::vector<std::string> techniques;
  std::vector<std::string> backends = {"vulkan", "opengl"};
  std::vector<RayCase> ray_cases;
  std::vector<std::pair<std::string, LoadedScene>> scenes;                            ///< name and parts
  std::map<std::string, double> values;                                               ///< "owner.parameter"
  int ray_image = 1024;                                                               ///< rays a case: ray_image²
  std::vector<HeightFilter> filters = {HeightFilter::exact, HeightFilter::hardware};  ///< of rays
  /// Else prisms are drawn of the techniques alone that hold a silhouette, and pixel offsets measured of those that
  /// always find the first hit.
  bool all_pictures = true;
  /// Timed rounds of rays. If more than 1, pictures are drawn again so often, and timed each time but the first.
  int repeats = 3;
  std::uint64_t crack_seeds = 3;  ///< random vertex orders that prisms are drawn in
  /// Of one Job's pictures, which bounds their memory: two, and one in all orders, stay together.
  std::size_t pixels_at_once = std::size_t{1} << 22;
  bool time = true;
  std::filesystem::path pictures;  ///< folder for PNGs; empty = none are written
  std::shared_ptr<BakedMaps> baked = std::make_shared<BakedMaps>();
  std::shared_ptr<PhaseClock> clock = std::make_shared<PhaseClock>();
};

/// One technique on one backend over the rays of a case at an angle.
struct RayRow {
  std::string case_name, technique, backend, filter;
  double angle = 0;
  ErrorFigures error;
  double seconds = -1;  ///< median; −1: not timed
};

/// Two backends on the same rays.
struct RayAgreement {
  std::string case_name, technique, filter;
  double angle = 0;
  std::uint64_t judged = 0;  ///< non-ambiguous rays
  double equal_percent = 0;  ///< of these: the same status, and t within `equal_ulps`
};

/// Hits of two backends are equal that differ by no more steps between floats of t.
inline constexpr std::int64_t equal_ulps = 4;
bool are_equal(const Hit& a, const Hit& b);

/// One picture.
struct PictureRow {
  std::string scene, stage, technique, backend;  ///< technique empty: the stage traces nothing
  std::string file;                              ///< PNG, relative to the pictures' folder; empty when none was written
  std::string difference_file;                   ///< against the oracle's picture; empty when there is none
  std::string flip_file;                         ///< the same as a map of FLIP
  double seconds = -1;                           ///< median; −1: not timed
  bool repeatable = true;                        ///< all runs byte-identical
  std::uint64_t degenerate_triangles = 0;
};

/// Pictures compared: two backends, or one backend's and the oracle's, or the prisms' and the finely displaced mesh's
/// ("vertex").
struct PictureAgreement {
  std::string scene, stage, technique, left, right;
  ImageDifference difference;
  double flip = -1;  ///< mean, against the oracle's only; −1: not measured
  std::optional<PixelOffsets>
      offsets;  ///< against the oracle's only, on the first backend: the hits are the same on all
};

/// Cracks of the prism stage under a random vertex order.
struct CrackRow {
  std::string scene, technique, backend;
  std::uint64_t seed = 0;
  std::uint64_t cracks = 0;
};

/// A claim and what was found. Failing checks make `conform` exit with 4.
struct Check {
  std::string name, found, expected;
  bool passed = false;
};

struct NotRun {
  std::string what, reason;
};

struct EvaluatedBackend {
  BackendInfo info;
  ValueTexts own_values;
};

struct Evaluation {
  std::vector<EvaluatedBackend> backends;
  std::vector<RayRow> rays;
  std::vector<RayAgreement> ray_agreements;
  std::vector<PictureRow> pictures;
  std::vector<PictureAgreement> picture_agreements;
  std::vector<CrackRow> cracks;
  std::vector<std::string> messages;  ///< of the validation layer and the debug output
  std::vector<Check> checks;
  std::vector<NotRun> not_run;
};

template <class Row>
void move_to(std::vector<Row>& all, std::vector<Row>& some) {
  all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
}

/// Whether a name in a row is that of one of its backends, and not the oracle's or a stage's.
bool is_backend(const Evaluation& evaluation, std::string_view name);

/// Runs everything. A backend that cannot be opened, or a stage that it cannot run, becomes a NotRun; an error of ours
/// is returned.
Result<Evaluation> evaluate(const EvaluationInput& input);

/// The parts of `evaluate`, each filling its rows. `backends` holds the opened ones by name.
using OpenBackends = std::map<std::string, std::unique_ptr<Backend>>;
/// Opens the named backends with validation; those that the machine lacks are told in `not_run`. An error when none is
/// left.
Result<OpenBackends> open_backends(const std::vector<std::string>& names, std::vector<BackendInfo>& infos,
                                   std::vector<NotRun>& not_run);
Status evaluate_rays(const EvaluationInput& input, OpenBackends& backends, Evaluation& evaluation, Progress& progress);
/// Pictures and cracks.
Status evaluate_pictures(const EvaluationInput& input, OpenBackends& backends, Evaluation& evaluation,
                         Progress& progress);
/// Whether a technique claims first hits at all: the others miss some, so their silhouettes and cracks say nothing of
/// the stage.
bool holds_silhouette(const Registry& registry, const std::string& technique);
bool always_finds_first_hit(const Registry& registry, const std::string& technique);
/// The claims, from the rows.
void judge(const EvaluationInput& input, Evaluation& evaluation);

nlohmann::json to_json(const Evaluation& evaluation);

/// `stem`, or "stem-2", "stem-3", …: rows and pictures are told apart by such names.
std::string unlike_others(const std::string& stem, const std::function<bool(const std::string&)>& is_taken);
bool is_name_of(const std::vector<RayCase>& cases, const std::string& name);

/// The file of "file" or "file:scale", and `scale` where it is given: what follows the last colon is a scale if it is
/// made of what numbers are made of. Errors: "cli.scale" for one that is not positive.
Result<std::string> split_scale(const std::string& item, double& scale);

/// Scenes and height files named on a command line → input. `heights` go through split_scale. Errors besides
/// those of what is loaded: "cli.set" for a filter.
Result<EvaluationInput> make_input(const Registry& registry, const std::vector<std::string>& techniques,
                                   const std::vector<std::string>& scenes, const std::vector<std::string>& heights,
                                   const std::string& address, const std::vector<std::string>& set);

}  // namespace relievo::cli
