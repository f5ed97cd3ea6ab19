/// Speed against error: who wins where, the plots, and the figures at the defaults.
#include <fmt/format.h>
#include <algorithm>

#include "report/heat.hpp"
#include "report/html.hpp"
#include "report/page.hpp"

namespace relievo::cli {

namespace {

using Rows = std::vector<const SweepRow*>;

/// The rows of a map at an angle on the first backend.
Rows rows_at(const Sweep& sweep, const std::string& map, double angle) {
  Rows rows;
  for (const SweepRow& row : sweep.rows) {
    if (row.map == map && row.angle == angle && row.backend == sweep.backends.front()) rows.push_back(&row);
  }
  return rows;
}

std::string full_label(const SweepRow& row) {
  return fmt::format("{} ({})", label(row.setting), to_string(row.setting.filter));
}

/// "exact (exact) 0.52×": the fastest that is never wrong, or the least wrong.
Cell winner(const Rows& rows) {
  const SweepRow* best = nullptr;
  for (const SweepRow* row : rows) {
    if (row->ratio <= 0 || row->error.judged == 0) continue;
    bool better = !best || std::pair(row->wrong_percent(), row->ratio) < std::pair(best->wrong_percent(), best->ratio);
    if (better) best = row;
  }
  if (!best) return {"–"};
  if (best->wrong_percent() == 0) return {fmt::format("{} {:.2f}×", full_label(*best), best->ratio), "pass"};
  return {
      fmt::format("none; {} {:.2f}×, wrong {} %", full_label(*best), best->ratio, percent_text(best->wrong_percent()))};
}

std::string winners_html(const Sweep& sweep) {
  std::vector<Column> columns = {{"map"}};
  for (double angle : sweep.plan.angles) columns.push_back({fmt::format("{}°", angle)});
  std::vector<std::vector<Cell>> rows;
  for (const std::string& map : sweep.maps) {
    if (!sweep.has_ratios(map)) continue;
    rows.push_back({{map, "name"}});
    for (double angle : sweep.plan.angles) rows.back().push_back(winner(rows_at(sweep, map, angle)));
  }
  return rows.empty() ? "" : "<h3>The fastest that is never wrong</h3>\n" + table(columns, rows);
}

/// What no other row beats in both time and wrong hits, fastest first.
std::string best_html(const Sweep& sweep, const std::string& map) {
  std::vector<std::vector<Cell>> rows;
  for (double angle : sweep.plan.angles) {
    Rows best = rows_at(sweep, map, angle);
    std::erase_if(best, [](const SweepRow* row) { return !row->best; });
    std::sort(best.begin(), best.end(), [](const SweepRow* a, const SweepRow* b) { return a->ratio < b->ratio; });
    for (const SweepRow* row : best)
      rows.push_back({{fmt::format("{}°", angle)},
                      {label(row->setting), "name"},
                      {std::string(to_string(row->setting.filter))},
                      {fixed(row->ratio, 3)},
                      {percent_text(row->wrong_percent())},
                      {error_text(row->error.height.p99)},
                      {fixed(row->error.mean_steps, 1)},
                      {fixed(row->error.mean_fetches, 1)}});
  }
  return "<details><summary>The non-dominated set: nothing else is at once faster and less wrong</summary>\n" +
         table({{"angle", true},
                {"setting"},
                {"filter"},
                {"× reference", true},
                {"wrong %", true},
                {"|ΔH| p99", true},
                {"steps", true},
                {"fetches", true}},
               rows) +
         "</details>\n";
}

/// Every technique at its defaults with the exact filter.
std::string defaults_html(const Sweep& sweep, const std::string& map) {
  std::vector<Column> columns = {{"technique"}};
  for (double angle : sweep.plan.angles) {
    columns.push_back({fmt::format("wrong % at {}°", angle), true});
    columns.push_back({"× reference", true});
    columns.push_back({"fetches", true});
  }
  std::vector<std::vector<Cell>> rows;
  for (double angle : sweep.plan.angles) {
    std::size_t line = 0;
    for (const SweepRow* row : rows_at(sweep, map, angle)) {
      if (!row->setting.loop.empty() || row->setting.filter != HeightFilter::exact) continue;
      if (line == rows.size()) rows.push_back({{row->setting.technique, "name"}});
      rows[line].push_back({percent_text(row->wrong_percent()), row->wrong_percent() == 0 ? "pass" : ""});
      rows[line].push_back({fixed(row->ratio, 2)});
      rows[line++].push_back({fixed(row->error.mean_fetches, 1)});
    }
  }
  return "<details><summary>Every technique at its defaults, exact filter</summary>\n" + table(columns, rows) +
         "</details>\n";
}

std::string plot_html(const Plot& plot) {
  std::string title = fmt::format("<h4>{}</h4>\n", escape(plot.kind->heading));
  if (!plot.problem.empty()) return title + fmt::format("<p>There is no plot: {}.</p>\n", escape(plot.problem));
  return title + "<div class=\"plot\">" + plot.svg + "</div>\n";
}

std::string map_html(const Report& report, const std::string& map, bool open) {
  std::string html = fmt::format("<details{}><summary><b>{}</b></summary>\n", open ? " open" : "", escape(map));
  html += defaults_html(report.sweep, map);
  if (report.sweep.has_ratios(map)) html += best_html(report.sweep, map);
  for (const Plot& plot : report.plots) {
    if (plot.map == map) html += plot_html(plot);
  }
  return html + "</details>\n";
}

std::string spread_html(const Sweep& sweep) {
  const Rerun& rerun = sweep.rerun;
  if (rerun.rows == 0) return {};
  return fmt::format(
      "<p>How far to trust a time: the {} timed settings of the first map at {}°, timed once more after the rest "
      "of the sweep, changed their ratio by {:.1f} % (median), {:.1f} % (nine of ten stay below) and {:.0f} % (worst). "
      "Errors, "
      "steps and reads do not change.</p>\n",
      rerun.rows, sweep.plan.angles.front(), rerun.median * 100, rerun.p90 * 100, rerun.worst * 100);
}

}  // namespace

std::string speed_section(const Report& report) {
  const Sweep& sweep = report.sweep;
  if (sweep.rows.empty()) return {};
  const SweepPlan& plan = sweep.plan;
  std::string html = fmt::format(
      "<section><h2>Speed against error</h2>\n"
      "<p>Each technique at its defaults, and with each of its loops at other counts, one at a time, with both "
      "filters: "
      "{} rows of {} rays, on {}{}; times are medians of {} runs over {} rays, interleaved{}. Time is a ratio to {} at "
      "its defaults "
      "with "
      "the hardware filter, which runs several times in each round. Here a ray whose budget runs out counts as wrong. "
      "Plots and "
      "tables are of {}; down and to the left is better. Solid: hardware filter; dashed: exact. What is never wrong is "
      "drawn at half a ray.</p>\n",
      sweep.rows.size(), plan.image * plan.image, escape(fmt::format("{}", fmt::join(sweep.backends, " and "))),
      sweep.backends.size() > 1 && plan.maps_elsewhere < sweep.maps.size() ? ", maps made by rule on the first" : "",
      plan.repeats, plan.timed_image * plan.timed_image,
      plan.times_all ? "" : ", of techniques at their defaults on the first map",
      sweep.reference.empty() ? "nothing" : escape(sweep.reference), escape(sweep.backends.front()));
  html += spread_html(sweep) + winners_html(sweep);
  bool open = true;
  for (const std::string& map : sweep.maps) {
    html += map_html(report, map, open);
    open = false;
  }
  return html + "</section>\n";
}

std::string costs_section(const Report& report) {
  if (report.sweep.costs.empty()) return {};
  std::vector<std::vector<Cell>> rows;
  for (const MapCost& cost : report.sweep.costs) {
    rows.push_back({{fmt::format("{}, {}×{}", cost.height, cost.width, cost.height_texels), "name"},
                    {cost.map, "name"},
                    {fixed(static_cast<double>(cost.bytes) / 1e6, 3)},
                    {fixed(static_cast<double>(cost.bytes) / cost.width / cost.height_texels, 1)},
                    {fixed(cost.bake_seconds * 1e3, 0)}});
  }
  return "<section><h2>What the maps take</h2>\n<p>Bytes as textures. Baking is timed with compiling the shader and "
         "reading the map back, what it is baked from apart.</p>\n<details><summary>Every map of every height "
         "map</summary>\n" +
         table({{"height map"}, {"map"}, {"MB", true}, {"bytes a height texel", true}, {"bake ms", true}}, rows) +
         "</details></section>\n";
}

Result<std::string> heat_section(const Report& report) {
  const Sweep& sweep = report.sweep;
  if (sweep.heat.empty()) return std::string();
  std::string html = fmt::format(
      "<section><h2>Where the steps go, and where the errors are</h2>\n<p>{} at {}°, exact filter, defaults. Left: "
      "steps, dark for one, bright for {:.0f}, logarithmic. Right: distance from the first hit, dark for 10⁻⁴ texels, "
      "bright for one; red: a wrong hit.</p>\n<div class=\"pictures\">\n",
      escape(sweep.maps.front()), sweep.heat_angle, most_steps(sweep.heat));
  for (const HeatMap& heat : sweep.heat) {
    Result<std::string> uri = png_uri(report.pictures / fmt::format("heat-{}.png", heat.technique));
    if (!uri) return uri;
    html += fmt::format(
        "<figure class=\"heat\"><img loading=\"lazy\" alt=\"steps and errors of {0}\" src=\"{1}\">"
        "<figcaption><b>{0}</b></figcaption></figure>\n",
        escape(heat.technique), *uri);
  }
  return html + "</div></section>\n";
}

}  // namespace relievo::cli
