#include "report/plot.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>

#include "report/gnuplot.hpp"

namespace relievo::cli {

namespace {

/// Paul Tol's muted colours, distinct to colour-blind readers, and black; with as many marks as are prime to them, so
/// that many techniques differ in one or the other.
constexpr std::array<const char*, 10> colors = {"#332288", "#cc6677", "#117733", "#ddaa33", "#88ccee",
                                                "#882255", "#44aa99", "#999933", "#aa4499", "#000000"};
constexpr std::array<int, 7> marks = {7, 5, 9, 11, 13, 6, 4};  // gnuplot's point types: filled ones, then open ones

/// What is never wrong is drawn at half a ray, so that a logarithm exists.
double wrong_lifted(const SweepRow& row) {
  return std::max(row.wrong_percent(), row.error.percent(1) / 2);
}
/// Errors in H below this are the float's, and drawn at it.
double height_lifted(const SweepRow& row) {
  constexpr double least = 1e-8;
  return std::isnan(row.error.height.p99) ? -1 : std::max(row.error.height.p99, least);
}
double time_of(const SweepRow& row) {
  return row.ratio;
}
double fetches_of(const SweepRow& row) {
  return row.error.mean_fetches;
}
double steps_of(const SweepRow& row) {
  return row.error.mean_steps;
}

std::string style_of(std::size_t technique, bool dashed) {
  return fmt::format("linecolor rgb '{}' linewidth 1.3 pointtype {} pointsize 0.5 {}",
                     colors[technique % colors.size()], marks[technique % marks.size()],
                     dashed ? "dashtype '-'" : "dashtype solid");
}

std::vector<std::string> techniques_of(const Sweep& sweep) {
  std::vector<std::string> names;
  for (const SweepRow& row : sweep.rows) {
    const std::string& name = row.setting.technique;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

struct Point {
  double x = 0, y = 0, order = 0;
};

std::string data_of(const std::vector<Point>& points) {
  std::string text;
  for (const Point& p : points) text += fmt::format("{:.4g} {:.4g}\n", p.x, p.y);
  return text;
}

/// Rows of one panel.
using Rows = std::vector<const SweepRow*>;

Rows rows_at(const Sweep& sweep, const std::string& map, const PlotKind& kind, double angle) {
  Rows rows;
  for (const SweepRow& row : sweep.rows) {
    bool here = row.map == map && row.angle == angle && row.backend == sweep.backends.front() &&
                (!kind.exact_only || row.setting.filter == HeightFilter::exact);
    if (here && kind.x(row) > 0 && kind.y(row) > 0) rows.push_back(&row);
  }
  return rows;
}

/// A technique's curves with one filter: a loop each, through the row in which all have their defaults.
std::map<std::string, std::vector<Point>> curves_of(const Sweep& sweep, const PlotKind& kind, const Rows& rows,
                                                    const std::string& technique, HeightFilter filter) {
  std::map<std::string, std::vector<Point>> curves;
  const SweepRow* standard = nullptr;
  for (const SweepRow* row : rows) {
    if (row->setting.technique != technique || row->setting.filter != filter) continue;
    if (row->setting.loop.empty()) standard = row;
    if (row->setting.loop.empty()) continue;
    curves[row->setting.loop].push_back({kind.x(*row), kind.y(*row), static_cast<double>(row->setting.count)});
  }
  if (standard && curves.empty()) curves[""] = {};
  for (auto& [loop, points] : curves) {
    auto count = sweep.defaults.find(technique + "." + loop);
    if (standard)
      points.push_back({kind.x(*standard), kind.y(*standard), count == sweep.defaults.end() ? 0 : count->second});
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.order < b.order; });
  }
  return curves;
}

/// The corners of the stairs under which nothing lies, from the left.
std::vector<Point> front_of(const PlotKind& kind, const Rows& rows) {
  std::vector<Point> points, front;
  for (const SweepRow* row : rows) points.push_back({kind.x(*row), kind.y(*row)});
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  for (const Point& p : points) {
    if (front.empty() || p.y < front.back().y) front.push_back(p);
  }
  return front;
}

std::string panel(const Sweep& sweep, const std::string& map, const PlotKind& kind, double angle, int index) {
  Rows rows = rows_at(sweep, map, kind, angle);
  std::string blocks, curves;
  std::size_t technique_index = 0;
  for (const std::string& technique : techniques_of(sweep)) {
    for (HeightFilter filter : {HeightFilter::hardware, HeightFilter::exact}) {
      bool dashed = filter == HeightFilter::exact && !kind.exact_only;
      for (const auto& [loop, points] : curves_of(sweep, kind, rows, technique, filter)) {
        std::string block = fmt::format("$p{}c{}{}{}", index, technique_index, to_string(filter), loop);
        blocks += fmt::format("{} << EOD\n{}EOD\n", block, data_of(points));
        curves += fmt::format(" {} with linespoints {} notitle,", block, style_of(technique_index, dashed));
      }
    }
    ++technique_index;
  }
  if (curves.empty()) return {};
  std::string front = fmt::format("$p{}front", index);
  blocks += fmt::format("{} << EOD\n{}EOD\n", front, data_of(front_of(kind, rows)));
  curves += fmt::format(
      " {0} with steps linecolor rgb '#999999' linewidth 1 dashtype solid notitle,"
      " {0} with points linecolor rgb '#000000' linewidth 1.2 pointtype 6 pointsize 1.3 notitle",
      front);
  return fmt::format("set title '{}° above the plane'\n", angle) + blocks + "plot" + curves + "\n";
}

/// A panel without axes that names the techniques.
std::string legend(const Sweep& sweep) {
  std::string entries;
  std::size_t index = 0;
  for (const std::string& technique : techniques_of(sweep))
    entries += fmt::format(" NaN with linespoints {} title '{}',", style_of(index++, false), technique);
  return "unset logscale\nunset border\nunset tics\nunset xlabel\nunset ylabel\nunset grid\nunset title\nset key at "
         "graph 0.5, graph 0.5 center center vertical reverse Left maxrows 24 samplen 2 spacing 0.95\nset xrange "
         "[0:1]\nset yrange "
         "[0:1]\nplot" +
         entries +
         " NaN with points linecolor rgb '#000000' linewidth 1.2 pointtype 6 pointsize 1.3 title 'not dominated'\n";
}

/// "m3tw": short, since every point of a plot refers to its mark by it.
std::string identifier(const Sweep& sweep, const std::string& map, const PlotKind& kind) {
  auto at = std::find(sweep.maps.begin(), sweep.maps.end(), map);
  return fmt::format("m{}{}", at - sweep.maps.begin(), kind.name);
}

}  // namespace

const std::vector<PlotKind>& plot_kinds() {
  static const std::vector<PlotKind> kinds = {
      {"tw", "Time against wrong hits", "time, as a ratio to the reference", "wrong hits, %", time_of, wrong_lifted,
       false},
      {"th", "Time against the 99th percentile of |ΔH| of the hits that are right", "time, as a ratio to the reference",
       "|ΔH|, 99th percentile", time_of, height_lifted, false},
      {"fw", "Texel reads against wrong hits", "texel reads a ray", "wrong hits, %", fetches_of, wrong_lifted, false},
      {"sw", "Wrong hits against steps, exact filter", "steps a ray", "wrong hits, %", steps_of, wrong_lifted, true}};
  return kinds;
}

std::string plot_script(const Sweep& sweep, const std::string& map, const PlotKind& kind,
                        const std::vector<double>& angles) {
  std::string panels;
  int index = 0;
  for (double angle : angles) panels += panel(sweep, map, kind, angle, index++);
  if (panels.empty()) return {};
  constexpr std::size_t columns = 3;
  std::size_t lines = (angles.size() + 1 + columns - 1) / columns;
  return fmt::format(
             "set terminal svg noenhanced size 1320,{} dynamic font 'sans-serif,12'\nset encoding utf8\n"
             "set multiplot layout {},{}\nset logscale xy\nset grid linecolor rgb '#dddddd' linetype 1\n"
             "set border 3 linecolor rgb '#555555'\nset tics nomirror\nset xlabel '{}' offset 0,0.4\nset ylabel '{}' "
             "offset 1,0\nset format '%g'\nset offsets graph 0.03, graph 0.03\nset key off\n",
             lines * 420, lines, columns, kind.across, kind.up) +
         panels + "set key on\n" + legend(sweep) + "unset multiplot\n";
}

Plot draw_plot(const Sweep& sweep, const std::string& map, const PlotKind& kind, const std::vector<double>& angles) {
  Plot plot{map, &kind, "", ""};
  std::string script = plot_script(sweep, map, kind, angles);
  if (script.empty()) {
    plot.problem = kind.x != time_of || sweep.has_ratios(map) ? "no setting has anything to show"
                   : sweep.has_ratios(sweep.maps.front())     ? "times are of the first map alone"
                   : sweep.reference.empty()                  ? "there is no reference to relate times to"
                                                              : "the backend has no timestamps";
    return plot;
  }
  Drawing drawing = run_gnuplot(script, identifier(sweep, map, kind));
  plot.svg = std::move(drawing.svg);
  plot.problem = std::move(drawing.problem);
  return plot;
}

}  // namespace relievo::cli
