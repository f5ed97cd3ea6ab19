/// Fuzzing of `trace`: random and adversarial maps, rays and parameters, for every technique on every backend.
#pragma once

#include "evaluation/evaluation.hpp"
#include "evaluation/hard_cases.hpp"
#include "evaluation/synthetic_maps.hpp"
#include "relievo/trace.hpp"

namespace relievo::cli {

struct FuzzInput {
  const Registry* registry = nullptr;
  std::vector<std::string> techniques, backends;
  std::uint64_t calls = 100000;  ///< rays in all, spread evenly over techniques and backends
  std::uint64_t seed = 1;
  int round = -1;        ///< only this one, to see a finding again; −1 = as many as the calls take
  double patience = 60;  ///< seconds that one job may take; ten times that ends the program
};

/// What one round tries.
struct FuzzRound {
  HeightMap map;
  HeightFilter filter = HeightFilter::exact;
  std::vector<Ray> rays;   ///< the plausible ones first
  std::size_t judged = 0;  ///< so many of them are held against the oracle
};

/// The same for the same seed, round and count, whatever the techniques.
FuzzRound draw_round(std::uint64_t seed, std::uint64_t round, std::size_t rays);

/// A technique's own values, those of its maps and of the stage: defaults, ends of their ranges, and between.
std::map<std::string, double> draw_values(const Registry& registry, const std::string& technique, std::uint64_t seed,
                                          std::uint64_t round);

/// One thing that must not happen, with what it takes to see it again.
struct FuzzFinding {
  std::string technique, backend, what;
  std::uint64_t round = 0;
};

/// One technique on one backend.
struct FuzzRow {
  std::string technique, backend;
  std::uint64_t calls = 0, hits = 0, exhausted = 0;
  std::uint64_t sanitized = 0;  ///< NaN within, which the stage made a miss: a ray's own numbers may overflow
  std::uint64_t non_finite = 0, bad_status = 0;
  std::uint64_t judged = 0, unsound = 0;  ///< wrong, missed or false where the first hit is claimed
  std::uint64_t jobs = 0, failed_jobs = 0, slow_jobs = 0;
  double seconds = 0, slowest = 0;  ///< wall clock, compiling and baking included
};

struct FuzzResult {
  std::vector<FuzzRow> rows;
  std::vector<FuzzFinding> findings;  ///< the first few
  std::uint64_t faults = 0;
  std::vector<NotRun> not_run;
  std::vector<std::string> messages;
  double seconds = 0;
};

/// Counts what is wrong with the hits of one job; the first of each kind becomes a finding.
/// `truth` is empty where nothing is claimed.
void judge_fuzz(const FuzzRound& round, std::span<const Hit> hits, std::span<const Hit> truth, FuzzRow& row,
                std::vector<std::string>& findings);

Result<FuzzResult> run_fuzz(const FuzzInput& input);

void print(const FuzzResult& result);
nlohmann::json to_json(const FuzzResult& result);

}  // namespace relievo::cli
