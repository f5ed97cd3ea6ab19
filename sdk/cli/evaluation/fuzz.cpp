#include "evaluation/fuzz.hpp"

#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "evaluation/hard_run.hpp"

namespace relievo::cli {

namespace {

constexpr std::size_t largest_job = 16384;  // rays
constexpr std::size_t smallest_job = 64;    // as many as a work group has
constexpr double steps_a_job = 2e7;         // a second or so on a software driver
constexpr std::size_t findings_kept = 20;

bool is_finite(const Hit& hit) {
  return std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v) && std::isfinite(hit.h);
}

std::string describe(const Ray& r, const Hit& h) {
  return fmt::format(
      "ray {:.17g},{:.17g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}: status {} at t {:.9g}, ({:.9g}, {:.9g}, "
      "{:.9g})",
      r.u, r.v, r.h, r.du, r.dv, r.dh, r.t_max, static_cast<int>(h.status), h.t, h.u, h.v, h.h);
}

/// Ends the program, saying where it was, when a job does not come back: an API call cannot be cancelled.
class Watchdog {
 public:
  Watchdog() : thread_([this] { watch(); }) {}
  ~Watchdog() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  void expect(std::string what, double seconds) {
    const std::lock_guard lock(mutex_);
    what_ = std::move(what);
    deadline_ = Clock::now() + std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000));
    changed_.notify_all();
  }
  void rest() { expect("", 1e6); }

 private:
  using Clock = std::chrono::steady_clock;

  void watch() {
    std::unique_lock lock(mutex_);
    while (!done_) {
      if (changed_.wait_until(lock, deadline_) != std::cv_status::timeout || done_ || what_.empty()) continue;
      if (Clock::now() < deadline_) continue;
      fmt::print(stderr, "error: {} does not come back [fuzz.hang]\n", what_);
      std::fflush(nullptr);
      std::_Exit(exit_code(ErrorCode::mismatch));
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string what_;
  Clock::time_point deadline_ = Clock::now() + std::chrono::hours(24);
  bool done_ = false;
  std::thread thread_;
};

/// Fewer rays where each may take many steps.
std::size_t rays_for(const TechniqueDescriptor& technique, const std::map<std::string, double>& values,
                     std::size_t most) {
  double steps = 64;
  for (const Parameter& p : technique.parameters) {
    if (p.is_loop && technique.first_hit != FirstHit::always) steps += values.at(technique.name + "." + p.name);
  }
  const auto affordable = static_cast<std::size_t>(steps_a_job / steps);
  return std::min(most, std::max(affordable, smallest_job));
}

class Run {
 public:
  Run(const FuzzInput& input, OpenBackends& backends, FuzzResult& result)
      : input_(input), backends_(backends), result_(result) {
    for (const std::string& technique : input.techniques) {
      for (const auto& [name, backend] : backends) result_.rows.push_back({technique, name});
    }
    quota_ = std::max<std::uint64_t>(1, (input.calls + result_.rows.size() - 1) / result_.rows.size());
  }

  void rounds() {
    const std::uint64_t first = input_.round < 0 ? 0 : static_cast<std::uint64_t>(input_.round);
    Progress progress("fuzz", static_cast<std::size_t>(quota_ / largest_job + 1));
    bool more = true;
    for (std::uint64_t k = first; more; ++k) {
      progress.advance(fmt::format("round {}", k));
      more = round(k) && input_.round < 0;
    }
  }

 private:
  /// Returns whether any technique has calls left.
  bool round(std::uint64_t k) {
    const FuzzRound whole =
        draw_round(input_.seed, k, static_cast<std::size_t>(std::min<std::uint64_t>(quota_, largest_job)));
    const std::vector<Hit> truth = truth_of(whole);
    bool more = false;
    for (FuzzRow& row : result_.rows) {
      if (row.calls < quota_) job(whole, truth, k, row);
      more = more || row.calls < quota_;
    }
    return more;
  }

  std::vector<Hit> truth_of(const FuzzRound& round) const {
    if (round.filter != HeightFilter::exact) return {};
    std::vector<Hit> truth = Oracle(round.map).trace(std::span(round.rays).first(round.judged));
    mark_domain_grazes(round.map, std::span(round.rays).first(round.judged), truth);
    return truth;
  }

  void job(const FuzzRound& whole, const std::vector<Hit>& truth, std::uint64_t k, FuzzRow& row) {
    const TechniqueDescriptor& technique = input_.registry->techniques.at(row.technique);
    const TraceRequest request{row.technique, whole.filter, true,
                               draw_values(*input_.registry, row.technique, input_.seed, k)};
    const std::size_t count = std::min<std::size_t>(rays_for(technique, request.values, whole.rays.size()),
                                                    static_cast<std::size_t>(quota_ - row.calls));
    const FuzzRound round = part_of(whole, count);
    watchdog_.expect(fmt::format("{} on {} in round {} of seed {}", row.technique, row.backend, k, input_.seed),
                     10 * input_.patience);
    const auto start = std::chrono::steady_clock::now();
    MapSet maps = map_set(round.map);
    Result<std::vector<TraceResult>> traced =
        trace(*backends_.at(row.backend), *input_.registry, maps, round.rays, {&request, 1}, 1, &result_.messages);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    watchdog_.rest();
    row.calls += round.rays.size();
    ++row.jobs;
    row.seconds += seconds;
    row.slowest = std::max(row.slowest, seconds);
    std::vector<std::string> findings;
    if (seconds > input_.patience) {
      ++row.slow_jobs;
      findings.push_back(fmt::format("{:.1f} s for {} rays", seconds, round.rays.size()));
    }
    if (traced) {
      const bool is_claimed = technique.first_hit == FirstHit::always && !truth.empty();
      judge_fuzz(round, traced->front().hits,
                 is_claimed ? std::span(truth).first(round.judged) : std::span<const Hit>(), row, findings);
    } else {
      ++row.failed_jobs;
      findings.push_back(format(traced.error()));
    }
    keep(findings, request, row, k);
  }

  /// Some of the plausible rays and some of the adversarial ones, in this order.
  static FuzzRound part_of(const FuzzRound& whole, std::size_t count) {
    if (count >= whole.rays.size()) return whole;
    FuzzRound part{whole.map, whole.filter, {}, std::min(whole.judged, (count + 1) / 2)};
    const std::size_t others = std::min(count - part.judged, whole.rays.size() - whole.judged);
    const auto at = [&](std::size_t i) { return whole.rays.begin() + static_cast<std::ptrdiff_t>(i); };
    part.rays.assign(at(0), at(part.judged));
    part.rays.insert(part.rays.end(), at(whole.judged), at(whole.judged + others));
    return part;
  }

  void keep(const std::vector<std::string>& findings, const TraceRequest& request, const FuzzRow& row,
            std::uint64_t k) {
    result_.faults += findings.size();
    for (const std::string& what : findings) {
      if (result_.findings.size() >= findings_kept) return;
      std::string values;
      for (const auto& [name, value] : request.values) values += fmt::format(" {}={:.9g}", name, value);
      result_.findings.push_back(
          {row.technique, row.backend, fmt::format("{}; filter {},{}", what, to_string(request.filter), values), k});
    }
  }

  const FuzzInput& input_;
  OpenBackends& backends_;
  FuzzResult& result_;
  std::uint64_t quota_ = 0;
  Watchdog watchdog_;
};

}  // namespace

void judge_fuzz(const FuzzRound& round, std::span<const Hit> hits, std::span<const Hit> truth, FuzzRow& row,
                std::vector<std::string>& findings) {
  const std::uint64_t before[] = {row.non_finite, row.bad_status};
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    row.hits += hit.status == HitStatus::hit || hit.status == HitStatus::inside;
    row.exhausted += hit.status == HitStatus::exhausted;
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
  findings.push_back(fmt::format("{} of {} rays, first {}; the oracle says {} at t {:.9g}; {}x{} map, {}", judged.fault,
                                 judged.error.judged, describe(e.ray, e.found), to_string(e.truth.status), e.truth.t,
                                 round.map.width, round.map.height, to_string(round.map.address)));
}

Result<FuzzResult> run_fuzz(const FuzzInput& input) {
  const auto start = std::chrono::steady_clock::now();
  FuzzResult result;
  std::vector<BackendInfo> infos;
  Result<OpenBackends> backends = open_backends(input.backends, infos, result.not_run);
  if (!backends) return tl::unexpected(backends.error());
  Run(input, *backends, result).rounds();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

void print(const FuzzResult& result) {
  for (const NotRun& n : result.not_run) fmt::print("not run: {}, because {}\n", n.what, n.reason);
  fmt::print("{:<22} {:<8} {:>10} {:>10} {:>10} {:>5} {:>9} {:>8} {:>6} {:>9}\n", "technique", "backend", "calls",
             "hits", "exhausted", "NaN", "judged", "unsound", "failed", "slowest s");
  std::uint64_t calls = 0;
  for (const FuzzRow& r : result.rows) {
    calls += r.calls;
    fmt::print("{:<22} {:<8} {:>10} {:>10} {:>10} {:>5} {:>9} {:>8} {:>6} {:>9.2f}\n", r.technique, r.backend, r.calls,
               r.hits, r.exhausted, r.non_finite + r.bad_status, r.judged, r.unsound, r.failed_jobs, r.slowest);
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
