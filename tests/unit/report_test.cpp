/// The report's page: text is escaped, pictures come back, plots say what they could not draw.
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <sstream>

#include "cli/report/heat.hpp"
#include "cli/report/html.hpp"
#include "cli/report/picture_table.hpp"
#include "cli/report/plot.hpp"
#include "cli/report/synthetic.hpp"
#include "cli/report/thumbnail.hpp"

namespace relievo::cli {
namespace {

SweepRow row_of(const std::string& technique, int count, double ratio, std::uint64_t wrong, double angle = 20) {
  SweepRow row;
  row.map = "hills, \"and\" valleys";
  row.backend = "vulkan";
  row.angle = angle;
  row.setting = {technique, HeightFilter::hardware, count > 0 ? "linear_steps" : "", count};
  row.error.rays = row.error.judged = 1000;
  row.error.wrong_layer = wrong;
  row.error.mean_steps = 7;
  row.error.mean_fetches = 28;
  row.seconds = ratio / 100;
  row.spread = 0.1;
  row.ratio = ratio;
  return row;
}

Sweep two_points() {
  Sweep sweep;
  sweep.maps = {"hills, \"and\" valleys"};
  sweep.backends = {"vulkan"};
  sweep.plan.angles = {20};
  sweep.defaults = {{"relief.linear_steps", 100}};
  sweep.rows = {row_of("relief", 8, 0.25, 125), row_of("relief", 400, 4.0, 0), row_of("relief", 0, 1.0, 60)};
  return sweep;
}

const PlotKind& time_against_wrong() {
  return plot_kinds().front();
}

std::string script_of(const Sweep& sweep) {
  return plot_script(sweep, sweep.maps.front(), time_against_wrong(), sweep.plan.angles);
}

Plot plot_of(const Sweep& sweep) {
  return draw_plot(sweep, sweep.maps.front(), time_against_wrong(), sweep.plan.angles);
}

/// The environment variable for one test.
class ScopedPath {
 public:
  explicit ScopedPath(const char* value) : old_(std::getenv("PATH")) { setenv("PATH", value, 1); }
  ~ScopedPath() { setenv("PATH", old_.c_str(), 1); }

 private:
  std::string old_;
};

TEST(ReportHtml, EscapesWhatWouldBeMarkup) {
  EXPECT_EQ(escape("<a href=\"x\">'&'</a>"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
}

TEST(ReportHtml, TableEscapesCellsAndMarksNumbers) {
  std::string html = table({{"<name>"}, {"count", true}}, {{{"<script>"}, {"3", "pass"}}});
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_NE(html.find("&lt;script&gt;"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"n pass\">3</td>"), std::string::npos);
}

TEST(ReportHtml, Base64PadsAsTheRfcSays) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(ReportHtml, WhatWasNotMeasuredIsADash) {
  EXPECT_EQ(fixed(1.0 / 3, 3), "0.333");
  EXPECT_EQ(fixed(-1, 3), "–");
  EXPECT_EQ(fixed(std::nan(""), 3), "–");
}

TEST(ReportSweep, ANanInItFailsTheReport) {
  Sweep sweep = two_points();
  std::vector<Check> checks;
  check_finite(sweep, checks);
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_TRUE(checks[0].passed);
  EXPECT_EQ(checks[0].found, "0 in 3 rows");
  sweep.rows[1].error.non_finite = 2;
  check_finite(sweep, checks);
  EXPECT_FALSE(checks[1].passed);
  EXPECT_EQ(checks[1].found, "2 in 3 rows (relief, linear_steps = 400 on hills, \"and\" valleys at 20°)");
  check_finite({}, checks);
  EXPECT_EQ(checks.size(), 2U) << "nothing was swept";
}

TEST(ReportHtml, MissingPictureIsAnErrorWithItsFile) {
  Result<std::string> uri = png_uri("/nonexistent/picture.png");
  ASSERT_FALSE(uri);
  EXPECT_EQ(uri.error().id, "report.picture");
  EXPECT_EQ(uri.error().file, "/nonexistent/picture.png");
}

TEST(ReportPlot, LiftsWhatIsNeverWrongToHalfARayAndPutsTheDefaultIntoItsCurve) {
  std::string script = script_of(two_points());
  EXPECT_NE(script.find("0.25 12.5\n1 6\n4 0.05\n"), std::string::npos) << script;
}

TEST(ReportPlot, DrawsAnSvgWhoseIdentifiersAreItsOwn) {
  Plot plot = plot_of(two_points());
  ASSERT_EQ(plot.problem, "");
  EXPECT_EQ(plot.svg.rfind("<svg", 0), 0u);
  EXPECT_NE(plot.svg.find("id='m0twgpPt"), std::string::npos);
  EXPECT_EQ(plot.svg.find("id='gpPt"), std::string::npos);
  EXPECT_EQ(plot.svg.find("<script"), std::string::npos);
}

TEST(ReportPlot, SaysThatGnuplotIsMissing) {
  ScopedPath empty("/nonexistent");
  EXPECT_EQ(plot_of(two_points()).problem, "gnuplot is not installed");
}

TEST(ReportPlot, SaysThatThereAreNoTimestamps) {
  Sweep sweep = two_points();
  sweep.reference = "relief";
  for (SweepRow& row : sweep.rows) row.ratio = -1;
  EXPECT_EQ(plot_of(sweep).problem, "the backend has no timestamps");
  sweep.reference.clear();
  EXPECT_EQ(plot_of(sweep).problem, "there is no reference to relate times to");
}

TEST(ReportPlot, SaysThatTimesAreOfAnotherMap) {
  Sweep sweep = two_points();
  sweep.maps.insert(sweep.maps.begin(), "timed");
  sweep.rows.push_back(sweep.rows.front());
  sweep.rows.back().map = "timed";
  for (SweepRow& row : sweep.rows) row.ratio = row.map == "timed" ? 1 : -1;
  const Plot plot = draw_plot(sweep, sweep.maps.back(), time_against_wrong(), sweep.plan.angles);
  EXPECT_EQ(plot.problem, "times are of the first map alone");
}

TEST(ReportPlot, StepsAgainstErrorNeedNoTimestamps) {
  Sweep sweep = two_points();
  for (SweepRow& row : sweep.rows) {
    row.ratio = -1;
    row.setting.filter = HeightFilter::exact;
  }
  const PlotKind& steps = plot_kinds().back();
  EXPECT_NE(plot_script(sweep, sweep.maps.front(), steps, {20}).find("7 12.5\n"), std::string::npos);
}

TEST(ReportBest, MarksWhatNoOtherBeatsInBothAndNothingElse) {
  std::vector<SweepRow> rows = {row_of("slow", 0, 4, 0),        row_of("fast", 0, 1, 100),
                                row_of("dominated", 0, 2, 150), row_of("equal time, worse", 0, 1, 200),
                                row_of("untimed", 0, -1, 0),    row_of("another angle", 0, 9, 900, 8)};
  mark_best(rows);
  std::vector<bool> best;
  for (const SweepRow& row : rows) best.push_back(row.best);
  EXPECT_EQ(best, (std::vector<bool>{true, true, false, false, false, true}));
}

TEST(ReportBest, ARayWhoseBudgetRunsOutIsWrong) {
  std::vector<SweepRow> rows = {row_of("gives up", 0, 1, 0), row_of("finds", 0, 2, 0)};
  rows[0].error.exhausted = 10;
  mark_best(rows);
  EXPECT_EQ(rows[0].wrong_percent(), 1);
  EXPECT_TRUE(rows[1].best);
}

TEST(ReportBest, WhatIsNotJudgedIsNotThere) {
  std::vector<SweepRow> rows = {row_of("unjudged", 0, 0.5, 0), row_of("finds", 0, 1, 10)};
  rows[0].error.judged = 0;
  mark_best(rows);
  EXPECT_FALSE(rows[0].best);
  EXPECT_TRUE(rows[1].best);
}

/// The settings of a technique with one loop.
std::vector<int> counts_tried(double minimum, double maximum, double value, std::map<std::string, double> given = {}) {
  Registry registry;
  TechniqueDescriptor technique;
  technique.name = "t";
  Parameter loop;
  loop.name = "steps";
  loop.is_loop = loop.is_integer = true;
  loop.minimum = minimum;
  loop.maximum = maximum;
  loop.value = value;
  Parameter other;
  other.name = "width";
  technique.parameters = {loop, other};
  registry.techniques["t"] = technique;
  EvaluationInput input;
  input.registry = &registry;
  input.techniques = {"t"};
  input.values = std::move(given);
  std::vector<int> counts;
  Result<std::vector<Setting>> settings = make_settings(input, {});
  for (const Setting& s : *settings) {
    if (s.filter == HeightFilter::exact) counts.push_back(s.loop.empty() ? -1 : s.count);
  }
  return counts;
}

TEST(ReportSettings, ALoopIsTriedAroundItsDefaultWithinItsRange) {
  EXPECT_EQ(counts_tried(1, 65536, 100), (std::vector<int>{-1, 25, 50, 200, 400}));
  EXPECT_EQ(counts_tried(5, 16, 8), (std::vector<int>{-1, 5, 16}));
  EXPECT_EQ(counts_tried(1, 65536, 100, {{"t.steps", 40}}), (std::vector<int>{-1, 10, 20, 80, 160}));
}

TEST(ReportSettings, ABoundIsTriedWhereItBeginsToCut) {
  EXPECT_EQ(counts_tried(1, 16777216, 65536), (std::vector<int>{-1, 16, 64, 256}));
  EXPECT_EQ(counts_tried(1, 65536, 512), (std::vector<int>{-1, 16, 64, 256}));
  EXPECT_EQ(counts_tried(1, 65536, 256), (std::vector<int>{-1, 64, 128, 512, 1024})) << "a search";
  EXPECT_EQ(counts_tried(1, 65536, 100, {{"t.steps", 400}}), (std::vector<int>{-1, 100, 200, 800, 1600})) << "it too";
}

TEST(ReportCsv, QuotesNamesAndLeavesOutWhatWasNotMeasured) {
  Sweep sweep = two_points();
  sweep.rows[1].seconds = sweep.rows[1].spread = sweep.rows[1].ratio = -1;
  std::string csv = sweep_csv(sweep);
  EXPECT_NE(csv.find("\n\"hills, \"\"and\"\" valleys\",20,relief,linear_steps,8,hardware,vulkan,1000,0,1000,12.5,"),
            std::string::npos)
      << csv;
  EXPECT_NE(csv.find(",0.0025,0.1,0.25\n"), std::string::npos);
  EXPECT_NE(csv.find(",0,,,\n"), std::string::npos);
}

TEST(ReportCsv, EveryLineHasAsManyFieldsAsTheHeader) {
  Sweep sweep = two_points();
  for (SweepRow& row : sweep.rows) row.map = "hills";
  std::istringstream lines(sweep_csv(sweep));
  std::set<std::ptrdiff_t> commas;
  for (std::string line; std::getline(lines, line);) commas.insert(std::count(line.begin(), line.end(), ','));
  EXPECT_EQ(commas.size(), 1u);
}

TEST(ReportJson, HasEveryRowWithItsFigures) {
  nlohmann::json json = to_json(two_points());
  ASSERT_EQ(json["rows"].size(), 3u);
  EXPECT_EQ(json["rows"][0]["count"], 8);
  EXPECT_EQ(json["rows"][0]["ratio"], 0.25);
  EXPECT_FALSE(json["rows"][2].contains("loop"));
}

TEST(ReportHeat, ShowsWrongRaysRedAndUnjudgedOnesGrey) {
  constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  HeatMap heat{"t", 2, {1, 64, nan, 8}, {1e-6f, 1, nan, inf}};
  HeatPicture picture = draw_heat(heat, most_steps({heat}));
  ASSERT_EQ(picture.pixels.size(), static_cast<std::size_t>(picture.width * picture.height * 3));
  auto pixel = [&](int x, int y) {
    auto at = static_cast<std::size_t>(3 * (y * picture.width + x));
    return std::array<int, 3>{picture.pixels[at], picture.pixels[at + 1], picture.pixels[at + 2]};
  };
  const int right = picture.width - 2;
  const std::array<int, 3> dark = {40, 10, 70}, bright = {253, 231, 37}, grey = {150, 150, 150}, red = {214, 40, 40};
  EXPECT_EQ(pixel(0, 0), dark);
  EXPECT_EQ(pixel(1, 0), bright);
  EXPECT_EQ(pixel(0, 1), grey);
  EXPECT_EQ(pixel(right, 0), dark);
  EXPECT_EQ(pixel(right + 1, 0), bright);
  EXPECT_EQ(pixel(right, 1), grey);
  EXPECT_EQ(pixel(right + 1, 1), red);
}

TEST(ReportSynthetic, MapsAreWithinTheSlabAndNotFlat) {
  std::vector<NamedMap> maps = make_synthetic_maps(64);
  EXPECT_EQ(maps.size(), 6u);
  for (const NamedMap& map : maps) {
    ASSERT_EQ(map.height.texels.size(), 64u * 64u) << map.name;
    auto [lowest, highest] = std::minmax_element(map.height.texels.begin(), map.height.texels.end());
    EXPECT_GE(*lowest, 0) << map.name;
    EXPECT_LE(*highest, 1) << map.name;
    EXPECT_GT(*highest - *lowest, 0.5) << map.name;
  }
}

TEST(ReportThumbnail, IsTheMeanOfWhatItStandsForOverTheBackground) {
  Image image{4, 2, 4, {}};
  for (int i = 0; i < 8; ++i) {
    bool left = i % 4 < 2;
    for (float channel : {1.0f, 0.0f, i % 2 ? 1.0f : 0.0f, left ? 1.0f : 0.0f}) image.pixels.push_back(channel);
  }
  Image small = reduce(image, 2, 0.25f, 5);
  ASSERT_EQ(small.width, 2);
  ASSERT_EQ(small.height, 1);
  EXPECT_EQ(small.pixels, (std::vector<float>{1, 0, 0.5, 0.25, 0.25, 0.25}));
}

/// A prism drawn on two backends that agree, and the oracle's picture of it.
Evaluation pictures_of_two_backends() {
  Evaluation evaluation;
  for (const char* name : {"opengl", "vulkan"}) {
    BackendInfo backend;
    backend.name = name;
    evaluation.backends.push_back({backend, {}});
  }
  PixelOffsets offsets;
  offsets.judged = 1000;
  offsets.lost = 5;
  offsets.pixels = {0.25, 1.5, 9};
  ImageDifference difference;
  difference.psnr = 33.25;
  difference.mask_iou = 0.9875;
  evaluation.picture_agreements = {
      {"ball, \"red\"", "prism", "relief", "opengl", "oracle", difference, 0.0625, offsets},
      {"ball, \"red\"", "prism", "relief", "vulkan", "oracle", difference, 0.0626, {}},
      {"ball, \"red\"", "prism", "relief", "opengl", "vulkan", {}, -1, {}}};
  return evaluation;
}

TEST(PictureTable, HasOneRowForBackendsThatAgree) {
  Evaluation evaluation = pictures_of_two_backends();
  std::string html = picture_table(evaluation, "ball, \"red\"");
  for (const char* figure : {"33.2", "0.0625", "0.25", "1.50", "0.50", "0.9875"})
    EXPECT_NE(html.find(figure), std::string::npos) << figure;
  EXPECT_EQ(html.find("0.0626"), std::string::npos) << "the other backend's picture is the same";
  evaluation.picture_agreements[2].difference.within_percent = 99;
  EXPECT_NE(picture_table(evaluation, "ball, \"red\"").find("0.0626"), std::string::npos);
  EXPECT_EQ(picture_table(evaluation, "another scene"), "");
}

TEST(PictureTable, IsACsvFileOfAllBackends) {
  EXPECT_EQ(pictures_csv(pictures_of_two_backends()),
            "scene,stage,technique,backend,psnr,flip,offset_p50,offset_p99,offset_max,lost_percent,mask_iou\n"
            "\"ball, \"\"red\"\"\",prism,relief,opengl,33.25,0.0625,0.25,1.5,9,0.5,0.9875\n"
            "\"ball, \"\"red\"\"\",prism,relief,vulkan,33.25,0.0626,,,,,0.9875\n");
}

}  // namespace
}  // namespace relievo::cli
