/// Speed against error: the plots and the figures behind them.
#include <fmt/format.h>

#include "report/html.hpp"
#include "report/page.hpp"

namespace relievo::cli {

namespace {

std::string plot_html(const Plot& plot) {
  std::string title = fmt::format("<h3>At {}°</h3>\n", plot.angle);
  if (!plot.problem.empty()) return title + fmt::format("<p>There is no plot: {}.</p>\n", escape(plot.problem));
  return title + "<div class=\"plot\">" + plot.svg + "</div>\n";
}

std::string points_html(const Sweep& sweep) {
  std::vector<std::vector<Cell>> rows;
  for (const SweepPoint& p : sweep.points) {
    rows.push_back({{fixed(p.angle, 0) + "°"},
                    {p.technique, "name"},
                    {p.filter},
                    {p.loop.empty() ? "–" : fmt::format("{} = {}", p.loop, p.count), "name"},
                    {fixed(p.wrong_percent, 3)},
                    {fixed(p.seconds * 1e3, 2)},
                    {fixed(p.ratio, 2)}});
  }
  return "<details><summary>The figures behind the plots</summary>\n" +
         table({{"angle", true},
                {"technique"},
                {"filter"},
                {"loop", true},
                {"wrong %", true},
                {"ms", true},
                {"× relief", true}},
               rows) +
         "</details>\n";
}

}  // namespace

std::string speed_section(const Report& report) {
  const Sweep& sweep = report.sweep;
  if (sweep.points.empty()) return {};
  std::string html = fmt::format(
      "<section><h2>Speed against error</h2>\n"
      "<p>The loop that bounds each technique's search runs from 8 to 400 steps, and at its default; {} rays on {}, on "
      "{}. Solid: hardware filter; dashed: exact. "
      "Down and to the left is better. What is never wrong is drawn at half a ray, {} %. Here a ray whose budget runs "
      "out counts as wrong.</p>\n",
      sweep.image * sweep.image, escape(sweep.case_name), escape(sweep.backend),
      fmt::format("{:.2g}", sweep.points.front().resolution / 2));
  for (const Plot& plot : report.plots) html += plot_html(plot);
  return html + points_html(sweep) + "</section>\n";
}

}  // namespace relievo::cli
