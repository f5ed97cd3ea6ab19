/// The `ray` stage: every technique against the oracle, and the backends against each other.
#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <list>

#include "evaluation/at_once.hpp"
#include "evaluation/evaluation.hpp"
#include "relievo/trace.hpp"

namespace relievo::cli {

namespace {

/// Hits that a backend gives at once, unless one angle with one filter has more; fewer Jobs upload the maps and make
/// the pipelines fewer times.
constexpr std::size_t most_hits_at_once = std::size_t{1} << 21;

/// Some angles of one case with some filters, on all backends.
struct RayRun {
  const EvaluationInput& input;
  const RayCase& ray_case;
  std::map<std::string, double> values;  ///< with the case's scale
  std::vector<double> angles;
  std::vector<HeightFilter> filters;
  std::vector<std::vector<Ray>> rays;  ///< one set an angle
  std::vector<std::vector<Hit>> truth;

  std::size_t requests() const { return filters.size() * input.techniques.size(); }
  std::size_t index(std::size_t angle, std::size_t filter, std::size_t technique) const {
    return angle * requests() + filter * input.techniques.size() + technique;
  }
};

/// What a backend answers to a run, by RayRun::index.
struct Answers {
  Backend& backend;
  MapSet& maps;
  std::vector<std::vector<Hit>> hits = {};
  std::vector<double> seconds = {};  ///< medians, −1 without timestamps; empty: not timed
  std::vector<std::string> messages = {};
};

std::vector<TraceRequest> requests_of(const RayRun& run, const BackendInfo& backend, bool count) {
  std::vector<TraceRequest> list;
  for (HeightFilter filter : run.filters) {
    for (const std::string& technique : run.input.techniques) {
      TraceRequest request{technique, filter, count, values_on(*run.input.registry, backend, run.values)};
      list.push_back(std::move(request));
    }
  }
  return list;
}

/// Steps between two floats.
std::int64_t ulps(double a, double b) {
  const auto ordered = [](double x) {
    const auto bits = std::bit_cast<std::int32_t>(static_cast<float>(x));
    return static_cast<std::int64_t>(bits >= 0 ? bits : std::int32_t{-0x7fffffff} - 1 - bits);
  };
  return std::abs(ordered(a) - ordered(b));
}

RayAgreement agree(const std::vector<Hit>& truth, const std::vector<Hit>& a, const std::vector<Hit>& b) {
  RayAgreement agreement;
  std::uint64_t equal = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i].ambiguous) continue;
    ++agreement.judged;
    equal += are_equal(a[i], b[i]);
  }
  agreement.equal_percent = percent_of(equal, agreement.judged);
  return agreement;
}

Status bake_maps(const RayRun& run, Answers& answers) {
  for (const std::string& technique : run.input.techniques) {
    Status status = bake_required_maps(answers.backend, *run.input.registry, "ray", technique, answers.maps, run.values,
                                       &answers.messages);
    if (!status) return status;
  }
  return {};
}

/// To count what happens, in one round; or to time it.
Result<JobResult> execute(const RayRun& run, Answers& answers, TraceRounds rounds, bool count) {
  const BackendInfo& backend = answers.backend.info();
  Result<Job> job = make_trace_job(*run.input.registry, answers.maps, run.rays, requests_of(run, backend, count),
                                   backend.shader_target, rounds, count);
  if (!job) return tl::unexpected(job.error());
  Result<JobResult> result = answers.backend.execute(*job);
  if (result) move_to(answers.messages, result->messages);
  return result;
}

Status count(const RayRun& run, Answers& answers) {
  Result<JobResult> counted = execute(run, answers, {}, true);
  if (!counted) return tl::unexpected(counted.error());
  for (std::size_t i = 0; i < counted->read_backs.size(); ++i) {
    answers.hits.push_back(read_hits(counted->read_backs[i], run.rays[i / run.requests()]));
    counted->read_backs[i] = {};
  }
  return {};
}

Status time(const RayRun& run, Answers& answers) {
  const TraceRounds rounds{run.input.repeats, true};
  Result<JobResult> timed = execute(run, answers, rounds, false);
  if (!timed) return tl::unexpected(timed.error());
  for (const std::vector<double>& seconds : trace_seconds(*timed, run.rays.size(), run.requests(), rounds))
    answers.seconds.push_back(median(seconds));
  return {};
}

/// All backends at once; what is timed, one after another. Maps are there before the backends share them.
Status ask(const RayRun& run, std::list<Answers>& answers, Progress& progress) {
  for (Answers& one : answers) {
    if (Status status = bake_maps(run, one); !status) return status;
  }
  Status asked = for_each_at_once(answers, [&](Answers& one) {
    for (std::size_t i = 0; i < run.angles.size() * run.filters.size(); ++i)
      progress.advance(fmt::format("rays {} {}° {}", run.ray_case.name, run.angles.front(), one.backend.info().name));
    return count(run, one);
  });
  for (Answers& one : answers) {
    if (asked && run.input.time) asked = time(run, one);
  }
  return asked;
}

void add_rows(const RayRun& run, std::size_t angle, std::size_t filter, const std::string& backend,
              const Answers& answers, Evaluation& evaluation) {
  const HeightMap& height = run.ray_case.height;
  for (std::size_t k = 0; k < run.input.techniques.size(); ++k) {
    const std::size_t i = run.index(angle, filter, k);
    RayRow row{run.ray_case.name,
               run.input.techniques[k],
               backend,
               std::string(to_string(run.filters[filter])),
               run.angles[angle],
               compare_hits(run.truth[angle], answers.hits[i], height.width, height.height),
               answers.seconds.empty() ? -1 : answers.seconds[i]};
    evaluation.rays.push_back(std::move(row));
  }
}

void add_agreements(const RayRun& run, std::size_t angle, std::size_t filter, const Answers& left, const Answers& right,
                    Evaluation& evaluation) {
  for (std::size_t k = 0; k < run.input.techniques.size(); ++k) {
    const std::size_t i = run.index(angle, filter, k);
    RayAgreement agreement = agree(run.truth[angle], left.hits[i], right.hits[i]);
    agreement.case_name = run.ray_case.name;
    agreement.technique = run.input.techniques[k];
    agreement.angle = run.angles[angle];
    agreement.filter = to_string(run.filters[filter]);
    evaluation.ray_agreements.push_back(agreement);
  }
}

Status run_case(const RayRun& run, OpenBackends& backends, Evaluation& evaluation, Progress& progress) {
  std::list<Answers> answers;
  for (auto& [name, backend] : backends) {
    MapSet& maps = run.input.baked->of(*run.input.registry, run.ray_case.height, backend->info().name, run.values);
    answers.push_back({*backend, maps});
  }
  if (Status status = ask(run, answers, progress); !status) return status;
  for (Answers& one : answers) move_to(evaluation.messages, one.messages);
  for (std::size_t a = 0; a < run.angles.size(); ++a) {
    for (std::size_t f = 0; f < run.filters.size(); ++f) {
      for (const Answers& one : answers) add_rows(run, a, f, one.backend.info().name, one, evaluation);
      if (answers.size() > 1) add_agreements(run, a, f, answers.front(), *std::next(answers.begin()), evaluation);
    }
  }
  return {};
}

/// The case in as few runs as `most_hits_at_once` allows.
std::vector<RayRun> split(const EvaluationInput& input, const RayCase& ray_case) {
  const std::size_t rays = static_cast<std::size_t>(input.ray_image) * static_cast<std::size_t>(input.ray_image);
  const std::size_t an_angle = rays * input.techniques.size() * input.filters.size();
  const std::size_t angles = std::max<std::size_t>(1, most_hits_at_once / std::max<std::size_t>(1, an_angle));
  std::vector<std::vector<HeightFilter>> filters = {input.filters};
  if (an_angle > most_hits_at_once) {
    filters.clear();
    for (HeightFilter filter : input.filters) filters.push_back({filter});
  }
  std::map<std::string, double> values = input.values;
  set_scale(*input.registry, ray_case.scale, ray_case.height, values);
  std::vector<RayRun> runs;
  for (std::size_t first = 0; first < ray_case.angles.size(); first += angles) {
    const auto from = ray_case.angles.begin() + static_cast<std::ptrdiff_t>(first);
    const auto to = from + static_cast<std::ptrdiff_t>(std::min(angles, ray_case.angles.size() - first));
    for (const auto& some : filters) runs.push_back({input, ray_case, values, {from, to}, some, {}, {}});
  }
  return runs;
}

}  // namespace

bool are_equal(const Hit& a, const Hit& b) {
  return a.status == b.status && ulps(a.t, b.t) <= equal_ulps;
}

Status evaluate_rays(const EvaluationInput& input, OpenBackends& backends, Evaluation& evaluation, Progress& progress) {
  for (const RayCase& ray_case : input.ray_cases) {
    Oracle oracle(ray_case.height);
    std::vector<RayRun> runs = split(input, ray_case);
    RayRun* before = nullptr;
    for (RayRun& run : runs) {
      if (before && before->angles == run.angles) {
        run.rays = std::move(before->rays);
        run.truth = std::move(before->truth);
      }
      if (before) before->rays.clear(), before->truth.clear();
      before = &run;
      for (std::size_t i = run.rays.size(); i < run.angles.size(); ++i) {
        run.rays.push_back(make_view_rays(run.angles[i], ray_case.scale, input.ray_image, input.ray_image));
        run.truth.push_back(oracle.trace(run.rays.back()));
      }
      if (Status status = run_case(run, backends, evaluation, progress); !status) return status;
    }
  }
  return {};
}

}  // namespace relievo::cli
