/// `relievo report`: what it writes on a small scene and map, and what it refuses.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "relievo/image.hpp"
#include "support/child.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;

class ReportCli : public ::testing::Test {
 protected:
  void SetUp() override {
    const HeightMap map = smooth_noise_map(16, 16);
    ASSERT_TRUE(write_pfm(folder_ / "hills.pfm", Image{map.width, map.height, 1, map.texels}));
    ASSERT_TRUE(write_pfm(folder_ / "dales.pfm", Image{map.width / 2, map.height * 2, 1, map.texels}));
    folder_.write("ground.toml",
                  "[mesh]\nkind = \"plane\"\n[image]\nwidth = 24\nheight = 24\n[height_map]\npath = \"hills.pfm\"\n");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string written(const std::string& name) const { return TemporaryFolder::read(folder_ / ("out/" + name)); }

  /// The rows of a CSV file by column; every row must have as many values as the header.
  std::vector<std::map<std::string, std::string>> table(const std::string& name) const {
    std::istringstream lines(written(name));
    const auto split = [](const std::string& line) {
      std::vector<std::string> words(1);
      for (const char c : line) c == ',' ? static_cast<void>(words.emplace_back()) : words.back().push_back(c);
      return words;
    };
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = split(line);
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(lines, line)) {
      const std::vector<std::string> values = split(line);
      EXPECT_EQ(values.size(), names.size()) << name << ": " << line;
      for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) {
        if (i == 0) rows.emplace_back();
        rows.back()[names[i]] = values[i];
      }
    }
    return rows;
  }

  TemporaryFolder folder_;
};

/// The values of one column, each once.
std::set<std::string> values_of(const std::vector<std::map<std::string, std::string>>& rows,
                                const std::string& column) {
  std::set<std::string> values;
  for (const auto& row : rows) values.insert(row.contains(column) ? row.at(column) : "no such column");
  return values;
}

TEST_F(ReportCli, AQuickReportHasEveryFileAndTheyParse) {
  const ChildResult result =
      run_relievo({"report", "--quick", "--scene", path("ground.toml"), "--height", path("hills.pfm"), "--height",
                   path("dales.pfm"), "--techniques", "relief,parallax", "--ray-image", "16", "--sweep-image", "8",
                   "--repeats", "1", "-o", path("out")});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  using Names = std::set<std::string>;
  const auto json = nlohmann::json::parse(written("report.json"), nullptr, false);
  ASSERT_FALSE(json.is_discarded());
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["backends"].size(), 2U);
  EXPECT_TRUE(json["messages"].empty()) << json["messages"];
  Names judged;
  for (const auto& row : json["rays"]) judged.insert(row["technique"]);
  EXPECT_EQ(judged, (Names{"relief", "parallax"}));
  ASSERT_FALSE(json["checks"].empty());
  for (const auto& check : json["checks"]) EXPECT_EQ(check["passed"], true) << check;

  const auto sweep = table("report.csv"), pictures = table("pictures.csv");
  EXPECT_EQ(sweep.size(), json["sweep"]["rows"].size());
  EXPECT_EQ(values_of(sweep, "technique"), (Names{"relief", "parallax"}));
  EXPECT_EQ(values_of(sweep, "backend"), Names{"vulkan"}) << "a quick one sweeps on one";
  EXPECT_EQ(values_of(sweep, "map"), (Names{"hills", "dales"}));
  for (const auto& row : sweep) {
    const bool is_timed = row.at("map") == "hills" && row.at("loop").empty();
    EXPECT_EQ(row.at("seconds").empty(), !is_timed) << row.at("map") << row.at("technique") << row.at("loop");
  }
  EXPECT_EQ(values_of(sweep, "filter"), (Names{"hardware", "exact"}));
  for (const auto& row : json["rays"]) {
    EXPECT_EQ(row["filter"], "exact");
    EXPECT_FALSE(row.contains("seconds")) << row;
  }
  const auto is_judged = [](const auto& picture) { return picture["technique"] != "oracle"; };
  EXPECT_EQ(pictures.size(), std::count_if(json["pictures"].begin(), json["pictures"].end(), is_judged));
  EXPECT_EQ(values_of(pictures, "scene"), Names{"ground"});
  EXPECT_EQ(values_of(pictures, "stage"), (Names{"surface", "prism", "vertex"}));
  EXPECT_EQ(values_of(pictures, "backend"), (Names{"vulkan", "opengl"}));

  const std::string page = written("index.html");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  std::size_t shown = 0;
  const std::regex source("(?:src|href)=\"(pictures/[^\"]+)\"");
  for (std::sregex_iterator at(page.begin(), page.end(), source), end; at != end; ++at, ++shown) {
    const Result<Image> image = load_image(folder_ / ("out/" + (*at)[1].str()));
    EXPECT_TRUE(image) << (image ? "" : format(image.error()));
  }
  EXPECT_GT(shown, 10U);
}

TEST_F(ReportCli, AFullReportSweepsFilesOnAllBackendsAndMapsMadeByRuleOnOne) {
  const ChildResult result =
      run_relievo({"report", "--full", "--height", path("hills.pfm"), "--techniques", "parallax", "--ray-image", "4",
                   "--sweep-image", "2", "--repeats", "1", "-o", path("out")});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  using Names = std::set<std::string>;
  std::map<std::string, Names> backends;  // by map
  for (const auto& row : table("report.csv")) backends[row.at("map")].insert(row.at("backend"));
  EXPECT_EQ(backends.size(), 7U);
  for (const auto& [map, names] : backends)
    EXPECT_EQ(names, map == "hills" ? (Names{"vulkan", "opengl"}) : Names{"vulkan"}) << map;
  EXPECT_NE(result.out.find("not run: sweep of the height maps made by rule on all backends but the first"),
            std::string::npos)
      << result.out;
}

TEST_F(ReportCli, NothingToReportOnIsRefused) {
  const ChildResult none = run_relievo({"report", "-o", path("out")});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("[report.nothing]"), std::string::npos) << none.err;
  EXPECT_NE(none.err.find("--scene FILE or --height FILE"), std::string::npos) << none.err;
  const ChildResult missing = run_relievo({"report", "--height", path("missing.png"), "-o", path("out")});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("[report.nothing]"), std::string::npos) << missing.err;
  EXPECT_NE(missing.err.find("missing.png"), std::string::npos) << missing.err;
  EXPECT_FALSE(fs::exists(path("out")));
}

}  // namespace
}  // namespace relievo::test
