#include "evaluation/hard_run.hpp"

#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include <deque>

#include "measure/quantiles.hpp"
#include "relievo/trace.hpp"

namespace relievo::cli {

namespace {

/// The rays of one case within a group.
struct Part {
  const HardCase* hard_case = nullptr;
  std::size_t first = 0, count = 0;
};

/// Cases that share a map, and so its bakes and one job a technique.
struct Group {
  HeightMap map;
  int bits = 0;
  double scale = 0.1;
  std::vector<Part> parts;
  std::vector<Ray> rays;
  std::vector<Hit> truth;
};

void add_part(Group& group, const HardCase& item, int count) {
  const std::vector<Ray> rays = make_hard_rays(item.rays, group.map, count);
  group.parts.push_back({&item, group.rays.size(), rays.size()});
  group.rays.insert(group.rays.end(), rays.begin(), rays.end());
}

std::vector<Group> group_cases(const HardInput& input) {
  std::vector<Group> groups;
  std::vector<HardMap> maps;
  for (const HardCase& item : input.cases) {
    for (AddressMode address : item.addresses) {
      std::size_t k = 0;
      while (k < groups.size() && !(maps[k] == item.map && groups[k].map.address == address &&
                                    groups[k].bits == item.bits && groups[k].scale == item.rays.scale))
        ++k;
      if (k == groups.size()) {
        maps.push_back(item.map);
        groups.push_back({make_hard_map(item.map, address), item.bits, item.rays.scale, {}, {}, {}});
      }
      add_part(groups[k], item, input.rays);
    }
  }
  return groups;
}

/// Every kind of ray on the maps of the user; `cases` keeps what the parts point to.
void add_heights(const HardInput& input, std::deque<HardCase>& cases, std::vector<Group>& groups) {
  for (const HardHeight& height : input.heights) {
    groups.push_back({height.map, 0, height.scale, {}, {}, {}});
    for (std::string_view kind : hard_ray_kinds()) {
      HardCase item;
      item.name = fmt::format("{}_{}", height.name, kind);
      item.rays.kind = kind;
      item.rays.scale = height.scale;
      const bool is_periodic = height.map.address == AddressMode::repeat || height.map.address == AddressMode::mirror;
      item.rays.offset = is_periodic ? 1e6 : 16;  // where nothing repeats, the float itself is so large
      cases.push_back(std::move(item));
      add_part(groups.back(), cases.back(), input.rays);
    }
  }
}

/// Of every map that can be quantised, as near to the case's bits as it goes.
std::map<std::string, double> values_of(const HardInput& input, const Group& group) {
  std::map<std::string, double> values = input.values;
  if (group.bits != 0) {
    for (const auto& [name, map] : input.registry->maps) {
      if (map.rounding.empty()) continue;
      for (const Parameter& p : map.parameters) {
        if (p.name == "bits") values[name + ".bits"] = std::clamp<double>(group.bits, p.minimum, p.maximum);
      }
    }
  }
  set_scale(*input.registry, group.scale, group.map, values);
  return values;
}

/// The summary of one technique as it grows.
struct Tally {
  HardSummary summary;
  std::vector<double> uv, height;

  void add(const Group& group, const std::vector<Hit>& hits) {
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const Hit &truth = group.truth[i], &hit = hits[i];
      const auto is_hit = [](const Hit& h) { return h.status == HitStatus::hit; };
      if (truth.ambiguous || !is_hit(truth) || !is_hit(hit)) continue;
      const double du = std::abs(hit.u - truth.u) * group.map.width, dv = std::abs(hit.v - truth.v) * group.map.height;
      const double dh = std::abs(hit.h - truth.h);
      if (!(du <= 1 && dv <= 1 && dh <= 0.02)) continue;  // another layer, or NaN: counted as wrong
      uv.push_back(std::max(du, dv));
      height.push_back(dh);
    }
  }
  void compare(const Group& group, const std::vector<Hit>& a, const std::vector<Hit>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (group.truth[i].ambiguous) continue;
      ++summary.compared;
      summary.differing += !are_equal(a[i], b[i]);
    }
  }
};

class Run {
 public:
  Run(const HardInput& input, OpenBackends& backends, HardResult& result)
      : input_(input), backends_(backends), result_(result), tallies_(input.techniques.size()) {}

  Status group(Group& group) {
    group.truth = Oracle(group.map).trace(group.rays);
    mark_domain_grazes(group.map, group.rays, group.truth);
    std::map<std::string, MapSet> maps;
    for (const auto& [name, backend] : backends_) maps[name] = map_set(group.map);
    for (std::size_t k = 0; k < input_.techniques.size(); ++k) {
      std::optional<std::vector<Hit>> first;
      for (const auto& [name, backend] : backends_) {
        Result<std::vector<Hit>> hits = trace_with(input_.techniques[k], group, *backend, maps[name]);
        if (!hits && hits.error().code == ErrorCode::unsupported) {
          result_.not_run.push_back({input_.techniques[k] + " on " + name, hits.error().message});
          continue;
        }
        if (!hits) return tl::unexpected(hits.error());
        add_rows(input_.techniques[k], name, group, *hits);
        tallies_[k].add(group, *hits);
        if (first) tallies_[k].compare(group, *first, *hits);
        if (!first) first = std::move(*hits);
      }
    }
    return {};
  }

  void finish() {
    for (std::size_t k = 0; k < tallies_.size(); ++k) {
      HardSummary& summary = tallies_[k].summary;
      summary.technique = input_.techniques[k];
      summary.uv_p9999 = quantile(tallies_[k].uv, 0.9999);
      summary.height_p9999 = quantile(tallies_[k].height, 0.9999);
      for (const HardRow& row : result_.rows) {
        if (row.technique != summary.technique) continue;
        summary.judged += row.error.judged;
        summary.faults += !row.fault.empty();
      }
      result_.summaries.push_back(summary);
    }
  }

 private:
  Result<std::vector<Hit>> trace_with(const std::string& technique, const Group& group, Backend& backend,
                                      MapSet& maps) {
    const TraceRequest request{technique, HeightFilter::exact, true, values_of(input_, group)};
    Result<std::vector<TraceResult>> traced =
        trace(backend, *input_.registry, maps, group.rays, {&request, 1}, {}, &result_.messages);
    if (!traced) return tl::unexpected(traced.error());
    return std::move(traced->front().hits);
  }

  void add_rows(const std::string& technique, const std::string& backend, const Group& group,
                const std::vector<Hit>& hits) {
    const FirstHit claim = input_.registry->techniques.at(technique).first_hit;
    for (const Part& part : group.parts) {
      HardRow row =
          judge_hard_rays(group.map, std::span(group.rays).subspan(part.first, part.count),
                          std::span(group.truth).subspan(part.first, part.count),
                          std::span(hits).subspan(part.first, part.count), claim, part.hard_case->may_exhaust);
      row.technique = technique;
      row.backend = backend;
      row.case_name = part.hard_case->name;
      row.address = group.map.address;
      result_.rows.push_back(std::move(row));
    }
  }

  const HardInput& input_;
  OpenBackends& backends_;
  HardResult& result_;
  std::vector<Tally> tallies_;
};

}  // namespace

Result<HardResult> run_hard_cases(const HardInput& input) {
  const auto start = std::chrono::steady_clock::now();
  HardResult result;
  Result<OpenBackends> backends = open_backends(input.backends, result.backends, result.not_run);
  if (!backends) return tl::unexpected(backends.error());
  std::deque<HardCase> cases;
  std::vector<Group> groups = group_cases(input);
  add_heights(input, cases, groups);
  Progress progress("hard cases", groups.size());
  Run run(input, *backends, result);
  for (Group& group : groups) {
    progress.advance(group.parts.front().hard_case->name);
    if (Status status = run.group(group); !status) return tl::unexpected(status.error());
    group = {};
  }
  run.finish();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace relievo::cli
