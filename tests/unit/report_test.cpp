/// The report's page: text is escaped, pictures come back, plots say what they could not draw.
#include <gtest/gtest.h>
#include <cmath>
#include <cstdlib>

#include "cli/report/html.hpp"
#include "cli/report/plot.hpp"

namespace relievo::cli {
namespace {

Sweep two_points() {
  Sweep sweep;
  sweep.points.push_back({"relief", "hardware", 20, "linear_steps", 8, 12.5, 0.01, 0.002, 0.25});
  sweep.points.push_back({"relief", "hardware", 20, "linear_steps", 400, 0.0, 0.01, 0.016, 4.0});
  return sweep;
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

TEST(ReportHtml, MissingPictureIsAnErrorWithItsFile) {
  Result<std::string> uri = png_uri("/nonexistent/picture.png");
  ASSERT_FALSE(uri);
  EXPECT_EQ(uri.error().id, "report.picture");
  EXPECT_EQ(uri.error().file, "/nonexistent/picture.png");
}

TEST(ReportPlot, LiftsWhatIsNeverWrongToHalfARay) {
  std::string script = plot_script(two_points(), 20);
  EXPECT_NE(script.find("0.25 12.5\n4 0.005\n"), std::string::npos) << script;
}

TEST(ReportPlot, DrawsAnSvgWhoseIdentifiersAreItsOwn) {
  Plot plot = draw_plot(two_points(), 20);
  ASSERT_EQ(plot.problem, "");
  EXPECT_EQ(plot.svg.rfind("<svg", 0), 0u);
  EXPECT_EQ(plot.svg.find("id='gpPt"), std::string::npos);
  EXPECT_EQ(plot.svg.find("<script"), std::string::npos);
}

TEST(ReportPlot, SaysThatGnuplotIsMissing) {
  ScopedPath empty("/nonexistent");
  EXPECT_EQ(draw_plot(two_points(), 20).problem, "gnuplot is not installed");
}

TEST(ReportPlot, SaysThatThereAreNoTimestamps) {
  Sweep sweep = two_points();
  for (SweepPoint& point : sweep.points) point.ratio = -1;
  EXPECT_EQ(draw_plot(sweep, 20).problem, "the backend has no timestamps");
}

}  // namespace
}  // namespace relievo::cli
