#include "evaluation/fuzz.hpp"

#include <fmt/format.h>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "evaluation/hard_run.hpp"

namespace relievo::cli {

namespace {

constexpr std::size_t largest_job = 65536;  // rays
constexpr std::size_t smallest_job = 64;    // as many as a work group has
constexpr double steps_a_job = 1e8;         // some seconds on a software driver
constexpr std::uint64_t least_rounds = 8;   // however few calls there are
constexpr std::size_t findings_kept = 20;

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
    rays_a_job_ = static_cast<std::size_t>(std::clamp<std::uint64_t>(quota_ / least_rounds, smallest_job, largest_job));
  }

  void rounds() {
    const std::uint64_t first = input_.round < 0 ? 0 : static_cast<std::uint64_t>(input_.round);
    Progress progress("fuzz", static_cast<std::size_t>(quota_ / rays_a_job_ + 1));
    bool more = true;
    for (std::uint64_t k = first; more; ++k) {
      progress.advance(fmt::format("round {}", k));
      more = round(k) && input_.round < 0;
    }
  }

 private:
  /// Returns whether any technique has calls left.
  bool round(std::uint64_t k) {
    const FuzzRound whole = draw_round(input_.seed, k, rays_a_job_);
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
        trace(*backends_.at(row.backend), *input_.registry, maps, round.rays, {&request, 1}, {}, &result_.messages);
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
  std::size_t rays_a_job_ = 0;
  Watchdog watchdog_;
};

}  // namespace

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

}  // namespace relievo::cli
