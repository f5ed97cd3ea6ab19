/// Runs hard cases: every technique on every backend against the oracle.
#pragma once

#include <optional>

#include "evaluation/evaluation.hpp"
#include "evaluation/hard_cases.hpp"

namespace relievo::cli {

/// A height map of the user, on which every kind of ray is tried.
struct HardHeight {
  std::string name;
  HeightMap map;
  double scale = 0.1;
};

struct HardInput {
  const Registry* registry = nullptr;
  std::vector<std::string> techniques, backends;
  std::vector<HardCase> cases;
  std::vector<HardHeight> heights;
  int rays = 1000;  ///< a case and address mode
  std::map<std::string, double> values;
};

/// A ray that was judged to be wrong.
struct HardExample {
  Ray ray;
  Hit truth, found;
};

/// One technique on one backend over one case with one address mode.
struct HardRow {
  std::string technique, case_name, backend;
  AddressMode address = AddressMode::repeat;
  ErrorFigures error;
  std::uint64_t not_inside = 0;  ///< of rays right otherwise: start well below the surface, and not `inside` at t = 0
  std::string fault;             ///< which claim it breaks; empty: none
  std::optional<HardExample> example;

  std::uint64_t wrong() const { return error.wrong_layer + not_inside; }
};

/// Over all rays of one technique.
struct HardSummary {
  std::string technique;
  std::uint64_t judged = 0, faults = 0;
  double uv_p9999 = 0, height_p9999 = 0;  ///< of hits on the right layer: texels; H
  /// Rays between the first backend and the others; of these, those that are not are_equal.
  std::uint64_t compared = 0, differing = 0;
};

struct HardResult {
  std::vector<BackendInfo> backends;
  std::vector<HardRow> rows;
  std::vector<HardSummary> summaries;
  std::vector<NotRun> not_run;
  std::vector<std::string> messages;
  double seconds = 0;

  std::uint64_t faults() const;
};

/// What a technique may not do in a case; empty when all is well.
std::string fault_of(const HardRow& row, FirstHit claim, bool may_exhaust);

/// Calls ambiguous what only touches a corner or side of a clip map's domain, which the oracle's ambiguity in H does
/// not see.
void mark_domain_grazes(const HeightMap& map, std::span<const Ray> rays, std::span<Hit> truth);

/// The row of one technique's hits, with its fault and example. All spans have one length.
HardRow judge_hard_rays(const HeightMap& map, std::span<const Ray> rays, std::span<const Hit> truth,
                        std::span<const Hit> hits, FirstHit claim, bool may_exhaust);

Result<HardResult> run_hard_cases(const HardInput& input);

void print(const HardResult& result);
nlohmann::json to_json(const HardResult& result);

}  // namespace relievo::cli
