#include "report/page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/html.hpp"

namespace relievo::cli {

namespace {

constexpr const char* style = R"(
:root { color-scheme: light; --ink: #1d2126; --soft: #5c6670; --line: #dfe3e7; --bad: #b3261e; --good: #1b6e3c; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1400px; padding: 2rem 1.5rem 4rem; color: var(--ink); background: #fff;
  font: 15px/1.5 system-ui, "Segoe UI", "Helvetica Neue", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .6rem; }
h2 { font-size: 1.25rem; margin: 2.6rem 0 .6rem; padding-top: .8rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.8rem 0 .4rem; }
h4 { font-size: .95rem; margin: 1.2rem 0 .4rem; }
summary { cursor: pointer; margin: .6rem 0; }
p { max-width: 75ch; margin: .4rem 0 .8rem; }
.soft, figcaption { color: var(--soft); }
.verdict { font-weight: 600; }
.pass { color: var(--good); } .fail { color: var(--bad); font-weight: 600; }
.scroll { overflow-x: auto; margin: .5rem 0 1rem; }
table { border-collapse: collapse; font-size: .82rem; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .55rem; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
th { font-weight: 600; color: var(--soft); vertical-align: bottom; border-bottom-color: #aab2ba; }
th.n, td.n { text-align: right; }
td.n { white-space: nowrap; }
td.name { white-space: nowrap; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); gap: 1rem; margin: .4rem 0 1.2rem; }
.pairs { display: grid; grid-template-columns: repeat(auto-fill, minmax(400px, 1fr)); gap: .4rem 1.4rem; }
.pairs .pictures { grid-template-columns: 1fr 1fr; margin: 0 0 .6rem; gap: .6rem; }
figure { margin: 0; }
figure img { display: block; width: 100%; height: auto; background: #101316; border-radius: 3px; }
figcaption { font-size: .8rem; line-height: 1.4; margin-top: .3rem; font-variant-numeric: tabular-nums; }
figure.heat img { image-rendering: pixelated; }
figcaption b { color: var(--ink); font-weight: 600; }
.plot { max-width: 1320px; margin: .6rem 0 1.2rem; }
.plot svg { display: block; width: 100%; height: auto; }
@media (max-width: 640px) {
  body { padding: 1.2rem .9rem 3rem; }
  h1 { font-size: 1.4rem; }
  .pictures { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: .7rem; }
  th, td { padding: .25rem .5rem; }
}
)";

std::string introduction(const Report& report) {
  std::size_t failed = 0;
  for (const Check& c : report.evaluation.checks) failed += !c.passed;
  std::string verdict = failed == 0 ? fmt::format("All {} checks pass.", report.evaluation.checks.size())
                                    : fmt::format("{} of {} checks fail.", failed, report.evaluation.checks.size());
  return fmt::format(
      "<h1>How fast, and how wrong? Displacement-mapping techniques measured</h1>\n"
      "<p>Relievo compiles each technique once and runs it in every stage on every graphics API of this machine. Here "
      "{} are held "
      "against an exact oracle, which finds the first hit of every ray on the bilinear surface in double precision, "
      "and against each "
      "other across backends: {} rays a row, {}. Speed is quoted as a ratio to relief mapping in "
      "the same run, "
      "beside the steps and texel reads that it took; the milliseconds are this machine's.{}</p>\n"
      "<p class=\"verdict {}\">{}</p>\n",
      escape(fmt::format("{}", fmt::join(report.techniques, ", "))), report.ray_image * report.ray_image,
      report.repeats == 0   ? (report.sweep.is_timed() ? "timed in the sweep alone" : "not timed")
      : report.repeats == 1 ? "timed once"
                            : fmt::format("the median of {} runs", report.repeats),
      report.values.empty() ? "" : escape(fmt::format(" Set otherwise than described: {}.", to_text(report.values))),
      failed == 0 ? "pass" : "fail", escape(verdict));
}

}  // namespace

std::string checks_section(const Report& report) {
  std::vector<std::vector<Cell>> rows;
  for (const Check& c : report.evaluation.checks) {
    rows.push_back({{c.passed ? "pass" : "FAIL", c.passed ? "pass" : "fail"}, {c.name}, {c.found}, {c.expected}});
  }
  return "<section><h2>Checks</h2>\n" + table({{""}, {"claim"}, {"found"}, {"expected"}}, rows) + "</section>\n";
}

std::string machines_section(const Report& report) {
  const Evaluation& e = report.evaluation;
  std::vector<std::vector<Cell>> rows;
  for (const auto& [info, own] : e.backends) {
    rows.push_back(
        {{info.name, "name"}, {info.title}, {info.device}, {info.driver}, {info.api_version}, {to_text(own)}});
  }
  std::string html =
      "<section><h2>What ran where</h2>\n" +
      table({{"backend"}, {"API"}, {"device"}, {"driver"}, {"version"}, {"axes that it runs quicker so"}}, rows);
  if (e.not_run.empty()) return html + "<p>Everything that was asked for ran.</p></section>\n";
  std::vector<std::vector<Cell>> missing;
  for (const NotRun& n : e.not_run) missing.push_back({{n.what}, {n.reason}});
  return html + "<h3>What did not run</h3>\n" + table({{"what"}, {"because"}}, missing) + "</section>\n";
}

namespace {

/// "Where the time went: baking 24.1 s, …, 80 s in all (130 s of the processors)."
std::string time_html(const Report& report) {
  if (report.phases.empty()) return {};
  std::vector<std::string> parts;
  double seconds = 0, processor_seconds = 0;
  for (const Phase& p : report.phases) {
    parts.push_back(fmt::format("{} {} s", p.name, fixed(p.seconds, 1)));
    seconds += p.seconds;
    processor_seconds += p.processor_seconds;
  }
  return fmt::format("<p class=\"soft\">Where the time went: {}; {} s in all, {} s of processors.</p>\n",
                     escape(fmt::format("{}", fmt::join(parts, ", "))), fixed(seconds, 0), fixed(processor_seconds, 0));
}

}  // namespace

Result<std::string> make_page(const Report& report) {
  Result<std::string> gallery = gallery_section(report);
  if (!gallery) return tl::unexpected(gallery.error());
  Result<std::string> heat = heat_section(report);
  if (!heat) return tl::unexpected(heat.error());
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Relievo report</title>\n<style>";
  html += style;
  html += "</style>\n</head>\n<body>\n";
  html += introduction(report) + checks_section(report) + machines_section(report) + speed_section(report) + *heat +
          costs_section(report) + rays_section(report) + *gallery;
  html += time_html(report);
  html += fmt::format(
      "<p class=\"soft\">Relievo {}. The figures are in report.json, report.csv and pictures.csv "
      "beside this page.</p>\n</body>\n</html>\n",
      escape(RELIEVO_VERSION));
  return html;
}

}  // namespace relievo::cli
