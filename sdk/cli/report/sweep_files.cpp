/// The sweep as JSON and CSV.
#include <fmt/format.h>

#include "report/csv.hpp"
#include "report/sweep.hpp"

namespace relievo::cli {

namespace {

nlohmann::json row_json(const SweepRow& row) {
  nlohmann::json json = to_json(row.error);
  json.update({{"map", row.map},
               {"backend", row.backend},
               {"angle", row.angle},
               {"technique", row.setting.technique},
               {"filter", to_string(row.setting.filter)},
               {"steps", row.error.mean_steps},
               {"fetches", row.error.mean_fetches},
               {"best", row.best}});
  if (!row.setting.loop.empty()) json.update({{"loop", row.setting.loop}, {"count", row.setting.count}});
  if (row.seconds >= 0) json["seconds"] = row.seconds;
  if (row.spread >= 0) json["spread"] = row.spread;
  if (row.ratio >= 0) json["ratio"] = row.ratio;
  return json;
}

}  // namespace

nlohmann::json to_json(const Sweep& sweep) {
  nlohmann::json rows = nlohmann::json::array(), costs = nlohmann::json::array(), not_run = nlohmann::json::array();
  for (const SweepRow& row : sweep.rows) rows.push_back(row_json(row));
  for (const MapCost& cost : sweep.costs) {
    nlohmann::json json = {{"height", cost.height},
                           {"map", cost.map},
                           {"width", cost.width},
                           {"height_texels", cost.height_texels},
                           {"bytes", cost.bytes}};
    if (cost.bake_seconds >= 0) json["bake_seconds"] = cost.bake_seconds;
    costs.push_back(std::move(json));
  }
  for (const NotRun& n : sweep.not_run) not_run.push_back({{"what", n.what}, {"reason", n.reason}});
  const Rerun& rerun = sweep.rerun;
  return {{"maps", sweep.maps},
          {"backends", sweep.backends},
          {"rays", sweep.plan.image * sweep.plan.image},
          {"timed_rays", sweep.plan.timed_image * sweep.plan.timed_image},
          {"repeats", sweep.plan.repeats},
          {"reference", sweep.reference},
          {"defaults", sweep.defaults},
          {"seconds", sweep.seconds},
          {"rerun", {{"rows", rerun.rows}, {"median", rerun.median}, {"p90", rerun.p90}, {"worst", rerun.worst}}},
          {"map_costs", costs},
          {"not_run", not_run},
          {"rows", rows}};
}

std::string sweep_csv(const Sweep& sweep) {
  std::string text =
      "map,angle,technique,loop,count,filter,backend,rays,ambiguous,judged,wrong_percent,missed_percent,"
      "false_hit_percent,wrong_layer_percent,exhausted_percent,uv_texels_p50,uv_texels_p99,uv_texels_max,height_p50,"
      "height_p99,height_max,steps,fetches,best,seconds,spread,ratio\n";
  for (const SweepRow& r : sweep.rows) {
    const ErrorFigures& e = r.error;
    const Setting& s = r.setting;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}", csv_field(r.map), r.angle, csv_field(s.technique), s.loop,
                        s.loop.empty() ? "" : fmt::format("{}", s.count), to_string(s.filter), r.backend, e.rays,
                        e.ambiguous, e.judged);
    for (double figure : {e.wrong_percent(), e.percent(e.missed), e.percent(e.false_hit), e.percent(e.wrong_layer),
                          e.percent(e.exhausted), e.uv_texels.p50, e.uv_texels.p99, e.uv_texels.max, e.height.p50,
                          e.height.p99, e.height.max, e.mean_steps, e.mean_fetches})
      text += "," + csv_number(figure);
    text += fmt::format(",{}", r.best ? 1 : 0) +
            fmt::format(",{},{},{}\n", csv_number(r.seconds), csv_number(r.spread), csv_number(r.ratio));
  }
  return text;
}

}  // namespace relievo::cli
