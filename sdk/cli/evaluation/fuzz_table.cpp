#include <fmt/format.h>

#include "evaluation/fuzz.hpp"

namespace relievo::cli {

void print(const FuzzResult& result) {
  for (const NotRun& n : result.not_run) fmt::print("not run: {}, because {}\n", n.what, n.reason);
  fmt::print("{:<22} {:<8} {:>10} {:>10} {:>10} {:>9} {:>5} {:>9} {:>8} {:>6} {:>9}\n", "technique", "backend", "calls",
             "hits", "exhausted", "sanitized", "NaN", "judged", "unsound", "failed", "slowest s");
  std::uint64_t calls = 0;
  for (const FuzzRow& r : result.rows) {
    calls += r.calls;
    fmt::print("{:<22} {:<8} {:>10} {:>10} {:>10} {:>9} {:>5} {:>9} {:>8} {:>6} {:>9.2f}\n", r.technique, r.backend,
               r.calls, r.hits, r.exhausted, r.sanitized, r.non_finite + r.bad_status, r.judged, r.unsound,
               r.failed_jobs, r.slowest);
  }
  for (const FuzzFinding& f : result.findings)
    fmt::print("FAIL {} on {}, round {}: {}\n", f.technique, f.backend, f.round, f.what);
  fmt::print("{} messages of validation and debug output{}\n", result.messages.size(),
             result.messages.empty() ? "" : ", first: " + result.messages.front());
  const double rate = result.seconds > 0 ? static_cast<double>(calls) / result.seconds : 0;
  fmt::print("{} calls in {:.1f} s, {:.0f} a second: 1e8 calls take {:.1f} h\n", calls, result.seconds, rate,
             rate > 0 ? 1e8 / rate / 3600 : 0);
}

nlohmann::json to_json(const FuzzResult& result) {
  nlohmann::json json = {{"schema", 1},
                         {"seconds", result.seconds},
                         {"faults", result.faults},
                         {"messages", result.messages},
                         {"rows", nlohmann::json::array()},
                         {"findings", nlohmann::json::array()},
                         {"not_run", nlohmann::json::array()}};
  std::uint64_t calls = 0;
  for (const FuzzRow& r : result.rows) {
    calls += r.calls;
    json["rows"].push_back({{"technique", r.technique},
                            {"backend", r.backend},
                            {"calls", r.calls},
                            {"hits", r.hits},
                            {"exhausted", r.exhausted},
                            {"sanitized", r.sanitized},
                            {"non_finite", r.non_finite},
                            {"bad_status", r.bad_status},
                            {"judged", r.judged},
                            {"unsound", r.unsound},
                            {"jobs", r.jobs},
                            {"failed_jobs", r.failed_jobs},
                            {"slow_jobs", r.slow_jobs},
                            {"seconds", r.seconds},
                            {"slowest_s", r.slowest}});
  }
  json["calls"] = calls;
  json["calls_per_s"] = result.seconds > 0 ? static_cast<double>(calls) / result.seconds : 0.0;
  for (const FuzzFinding& f : result.findings)
    json["findings"].push_back(
        {{"technique", f.technique}, {"backend", f.backend}, {"round", f.round}, {"what", f.what}});
  for (const NotRun& n : result.not_run) json["not_run"].push_back({{"what", n.what}, {"reason", n.reason}});
  return json;
}

}  // namespace relievo::cli
