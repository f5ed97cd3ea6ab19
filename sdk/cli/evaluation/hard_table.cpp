#include <fmt/format.h>
#include <cmath>

#include "evaluation/hard_run.hpp"

namespace relievo::cli {

namespace {

/// A row of the printed table: one technique in one case, over address modes and backends.
struct Line {
  std::uint64_t rays = 0, ambiguous = 0, judged = 0, wrong = 0, missed = 0, false_hit = 0, exhausted = 0,
                non_finite = 0;

  void add(const HardRow& row) {
    rays += row.error.rays;
    ambiguous += row.error.ambiguous;
    judged += row.error.judged;
    wrong += row.wrong();
    missed += row.error.missed;
    false_hit += row.error.false_hit;
    exhausted += row.error.exhausted;
    non_finite += row.error.non_finite;
  }
};

void print_line(const std::string& technique, const std::string& name, const Line& l) {
  fmt::print("{:<22} {:<34} {:>9} {:>9} {:>7} {:>7} {:>7} {:>9} {:>5}\n", technique, name, l.rays, l.judged, l.wrong,
             l.missed, l.false_hit, l.exhausted, l.non_finite);
}

void print_technique(const HardResult& result, const HardSummary& summary) {
  std::vector<std::string> names;  // in the order of the cases
  std::map<std::string, Line> lines;
  Line all;
  for (const HardRow& row : result.rows) {
    if (row.technique != summary.technique) continue;
    if (!lines.contains(row.case_name)) names.push_back(row.case_name);
    lines[row.case_name].add(row);
    all.add(row);
  }
  for (const std::string& name : names) print_line(summary.technique, name, lines.at(name));
  print_line(summary.technique, "= all", all);
}

std::string text(const Ray& r) {
  return fmt::format("{:.17g},{:.17g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", r.u, r.v, r.h, r.du, r.dv, r.dh, r.t_max);
}

std::string text(const Hit& h) {
  return fmt::format("{} at t {:.9g}, ({:.9g}, {:.9g}, {:.9g})", to_string(h.status), h.t, h.u, h.v, h.h);
}

nlohmann::json json_of(const Hit& hit) {
  return {{"status", to_string(hit.status)},
          {"t", hit.t},
          {"u", hit.u},
          {"v", hit.v},
          {"h", hit.h},
          {"steps", hit.steps},
          {"fetches", hit.fetches},
          {"text", text(hit)}};
}

nlohmann::json json_of(const HardRow& row) {
  nlohmann::json json = {{"technique", row.technique},
                         {"case", row.case_name},
                         {"backend", row.backend},
                         {"address", to_string(row.address)},
                         {"rays", row.error.rays},
                         {"ambiguous", row.error.ambiguous},
                         {"judged", row.error.judged},
                         {"wrong", row.wrong()},
                         {"missed", row.error.missed},
                         {"false", row.error.false_hit},
                         {"exhausted", row.error.exhausted},
                         {"non_finite", row.error.non_finite},
                         {"steps", row.error.mean_steps},
                         {"fetches", row.error.mean_fetches},
                         {"uv_texels_max", row.error.uv_texels.max},
                         {"height_max", row.error.height.max}};
  if (row.fault.empty()) return json;
  json["fault"] = row.fault;
  if (row.example) {
    json["example"] = {{"ray", text(row.example->ray)},  // a line of rays.csv
                       {"oracle", json_of(row.example->truth)},
                       {"found", json_of(row.example->found)}};
  }
  return json;
}

}  // namespace

void print(const HardResult& result) {
  for (const NotRun& n : result.not_run) fmt::print("not run: {}, because {}\n", n.what, n.reason);
  fmt::print("{:<22} {:<34} {:>9} {:>9} {:>7} {:>7} {:>7} {:>9} {:>5}\n", "technique", "case", "rays", "judged",
             "wrong", "missed", "false", "exhausted", "NaN");
  for (const HardSummary& summary : result.summaries) print_technique(result, summary);
  for (const HardSummary& s : result.summaries) {
    fmt::print(
        "{}: {} rays judged, p99.99 of the right hits {} texel and {} in H; {} of {} rays differ between "
        "backends\n",
        s.technique, s.judged, error_text(s.uv_p9999), error_text(s.height_p9999), s.differing, s.compared);
  }
  for (const HardRow& row : result.rows) {
    if (row.fault.empty()) continue;
    fmt::print("FAIL {} on {}, case {}, {}: {}\n", row.technique, row.backend, row.case_name, to_string(row.address),
               row.fault);
    if (!row.example) continue;
    fmt::print("  ray    {}\n  oracle {}\n  found  {}\n", text(row.example->ray), text(row.example->truth),
               text(row.example->found));
  }
  fmt::print("{} messages of validation and debug output{}\n", result.messages.size(),
             result.messages.empty() ? "" : ", first: " + result.messages.front());
  fmt::print("{:.1f} s\n", result.seconds);
}

nlohmann::json to_json(const HardResult& result) {
  nlohmann::json json = {{"schema", 1},
                         {"seconds", result.seconds},
                         {"faults", result.faults()},
                         {"messages", result.messages},
                         {"rows", nlohmann::json::array()},
                         {"techniques", nlohmann::json::array()},
                         {"not_run", nlohmann::json::array()}};
  for (const HardRow& row : result.rows) json["rows"].push_back(json_of(row));
  for (const HardSummary& s : result.summaries) {
    json["techniques"].push_back({{"technique", s.technique},
                                  {"judged", s.judged},
                                  {"faults", s.faults},
                                  {"uv_texels_p9999", s.uv_p9999},
                                  {"height_p9999", s.height_p9999},
                                  {"compared", s.compared},
                                  {"differing", s.differing}});
  }
  for (const NotRun& n : result.not_run) json["not_run"].push_back({{"what", n.what}, {"reason", n.reason}});
  return json;
}

}  // namespace relievo::cli
