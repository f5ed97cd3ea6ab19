/// The `ray` stage's figures: a table a height map and angle.
#include <fmt/format.h>
#include <algorithm>
#include <tuple>

#include "report/html.hpp"
#include "report/page.hpp"

namespace relievo::cli {

namespace {

/// Columns of times, the last.
constexpr std::size_t times = 3;

bool same_rays(const RayRow& a, const RayRow& b) {
  return a.case_name == b.case_name && a.angle == b.angle;
}

/// `timed`: with the last three.
std::vector<Column> columns(bool timed) {
  std::vector<Column> list = {
      {"technique"},         {"filter"},        {"backend"},     {"wrong %", true}, {"missed %", true},
      {"exhausted %", true}, {"Δuv p50", true}, {"p99", true},   {"max", true},     {"|ΔH|·10³ p50", true},
      {"p99", true},         {"max", true},     {"steps", true}, {"fetches", true}, {"ms", true},
      {"Mrays/s", true},     {"× relief", true}};
  if (!timed) list.resize(list.size() - times);
  return list;
}

double million_rays_per_second(const RayRow& row) {
  return row.seconds > 0 ? static_cast<double>(row.error.rays) / row.seconds / 1e6 : -1;
}

/// The row's time over that of relief mapping with the same rays, filter and backend; −1 when there is none.
double ratio_to_relief(const Evaluation& evaluation, const RayRow& row) {
  for (const RayRow& other : evaluation.rays) {
    bool reference = other.technique == "relief" && same_rays(other, row) && other.filter == row.filter &&
                     other.backend == row.backend;
    if (reference && other.seconds > 0 && row.seconds > 0) return row.seconds / other.seconds;
  }
  return -1;
}

std::vector<Cell> cells(const Evaluation& evaluation, const RayRow& row, bool timed) {
  const ErrorFigures& e = row.error;
  std::vector<Cell> list = {{row.technique, "name"},
                            {row.filter},
                            {row.backend},
                            {percent_text(e.wrong_percent())},
                            {percent_text(e.percent(e.missed))},
                            {percent_text(e.percent(e.exhausted))},
                            {fixed(e.uv_texels.p50, 4)},
                            {fixed(e.uv_texels.p99, 4)},
                            {fixed(e.uv_texels.max, 4)},
                            {fixed(e.height.p50 * 1e3, 4)},
                            {fixed(e.height.p99 * 1e3, 4)},
                            {fixed(e.height.max * 1e3, 4)},
                            {fixed(e.mean_steps, 1)},
                            {fixed(e.mean_fetches, 1)},
                            {fixed(row.seconds * 1e3, 2)},
                            {fixed(million_rays_per_second(row), 2)},
                            {fixed(ratio_to_relief(evaluation, row), 2)}};
  if (!timed) list.resize(list.size() - times);
  return list;
}

/// The rows of one height map at one angle, technique by technique.
std::string case_html(const Evaluation& evaluation, const RayRow& first) {
  std::vector<const RayRow*> rows;
  for (const RayRow& row : evaluation.rays) {
    if (same_rays(row, first)) rows.push_back(&row);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const RayRow* a, const RayRow* b) {
    return std::tie(a->technique, a->filter, a->backend) < std::tie(b->technique, b->filter, b->backend);
  });
  const bool timed = std::any_of(rows.begin(), rows.end(), [](const RayRow* row) { return row->seconds >= 0; });
  std::vector<std::vector<Cell>> table_rows;
  for (const RayRow* row : rows) table_rows.push_back(cells(evaluation, *row, timed));
  return fmt::format(
             "<h3>{} at {}°</h3>\n<p class=\"soft\">{} rays, of which {} pass within 10⁻⁵ of the surface without "
             "crossing it and are not judged.</p>\n",
             escape(first.case_name), first.angle, first.error.rays, first.error.ambiguous) +
         table(columns(timed), table_rows);
}

}  // namespace

std::string rays_section(const Report& report) {
  const std::vector<RayRow>& rows = report.evaluation.rays;
  if (rows.empty()) return {};
  std::string html =
      "<section><h2>Rays against the oracle</h2>\n"
      "<p>Wrong is a hit that the oracle has not, none where it has one, or one on another layer: more than a texel or "
      "0.02 in H away. "
      "Δuv (texels) and |ΔH| (thousandths of the relief's height) are over the other hits. The hardware filter has 8 "
      "fractional bits; "
      "the exact one interpolates in float. Steps and fetches are means a ray.</p>\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    bool seen = std::any_of(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(i),
                            [&](const RayRow& r) { return same_rays(r, rows[i]); });
    if (!seen) html += case_html(report.evaluation, rows[i]);
  }
  return html + "</section>\n";
}

}  // namespace relievo::cli
