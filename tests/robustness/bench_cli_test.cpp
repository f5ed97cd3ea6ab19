/// `relievo bench --embree`: the rival is traced rightly. Where every cell is a plane, its triangles are the surface
/// itself, and it must find what the oracle finds; where cells are saddles, it cannot.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relievo/image.hpp"
#include "support/child.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {
namespace {

nlohmann::json bench(const HeightMap& map, std::vector<std::string> more, int exit_code = 0) {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_pfm(folder / "height.pfm", Image{map.width, map.height, 1, map.texels}));
  std::vector<std::string> words = {"bench",    "--techniques", "exact", "--height", (folder / "height.pfm").string(),
                                    "--embree", "--repeat",     "1",     "--json"};
  words.insert(words.end(), more.begin(), more.end());
  const ChildResult result = run_relievo(words);
  EXPECT_EQ(result.exit_code, exit_code) << result.err << result.out;
  return nlohmann::json::parse(result.out, nullptr, false);
}

TEST(BenchCli, EmbreeFindsWhatTheOracleFindsOnPlanes) {
  for (const bool across : {false, true}) {
    const auto rows = bench(ridge_map(33, 20, across, 5), {"--angle", "15"});
    ASSERT_EQ(rows.size(), 2U) << rows;
    const auto& rival = rows[1];
    EXPECT_EQ(rival["technique"], "embree");
    // Rays through the very edge of two triangles, and those that just touch a ridge, differ in float.
    EXPECT_LT(rival["wrong_percent"].get<double>(), 0.01) << rival;
    EXPECT_LT(rival["height"]["p99"].get<double>(), 1e-5) << rival;
    EXPECT_EQ(rival["methods"].size(), 5U);
    EXPECT_GT(rival["rays_per_s"].get<double>(), 0.0);
    EXPECT_GE(rival["triangle_bytes"].get<int>(), 34 * 21 * 12 + 33 * 20 * 24);
    EXPECT_GT(rival["map_bytes"].get<int>(), rival["triangle_bytes"].get<int>()) << "its tree takes memory too";
    EXPECT_EQ(rows[0]["map_bytes"].get<int>(), 4 * (33 * 20 + 64 * 32 + 32 * 16 + 16 * 8 + 8 * 4 + 4 * 2 + 2 + 1));
  }
}

TEST(BenchCli, EveryRowSaysWithWhichValuesItRan) {
  const auto own = bench(ramp_map(8, 8), {"--techniques", "quadrant_maxima"});
  using Texts = std::map<std::string, std::string>;
  EXPECT_EQ(own[0]["values"].get<Texts>(), (Texts{{"ray.scale", "0.1"}, {"ray.storage", "image"}})) << "exact";
  EXPECT_EQ(own[1]["values"].get<Texts>(),
            (Texts{{"quadrant_maxima.fetch", "image"}, {"ray.scale", "0.1"}, {"ray.storage", "image"}}));
  EXPECT_EQ(own[2]["values"].get<Texts>(), Texts()) << "Embree";
  const auto set = bench(ramp_map(8, 8), {"--set", "ray.storage=buffer"});
  EXPECT_EQ(set[0]["values"].get<Texts>(), (Texts{{"ray.scale", "0.1"}, {"ray.storage", "buffer"}}));
}

TEST(BenchCli, TheSameComparisonSeesThatTrianglesAreNotTheSurface) {
  const auto rows = bench(checker_map(32, 32), {"--angle", "15"});
  ASSERT_EQ(rows.size(), 2U) << rows;
  EXPECT_GT(rows[1]["wrong_percent"].get<double>(), 0.1) << rows[1];
  EXPECT_EQ(rows[0]["wrong_percent"].get<double>(), 0.0);
}

TEST(BenchCli, EmbreeIsRefusedWhereTheMapDoesNotRepeat) {
  const auto error = bench(ramp_map(8, 8), {"--address", "clip"}, 1);
  EXPECT_EQ(error["error"]["id"], "bench.embree-address") << error;
}

}  // namespace
}  // namespace relievo::test
