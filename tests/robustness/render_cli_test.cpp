/// `relievo render`: a scene as a picture and as numbers, and the numbers as a picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "relievo/image.hpp"
#include "support/child.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {
namespace {

constexpr int width = 48, height = 32;

class RenderCli : public ::testing::Test {
 protected:
  void SetUp() override {
    const HeightMap map = smooth_noise_map(12, 8);
    ASSERT_TRUE(write_pfm(folder_ / "height.pfm", Image{map.width, map.height, 1, map.texels}));
    folder_.write("scene.toml",
                  "[image]\nwidth = 48\nheight = 32\n[mesh]\nkind = \"torus\"\n"
                  "[height_map]\npath = \"height.pfm\"\n[camera]\nposition = [0, -4, 3]\ntarget = [0, 0, 0]\n");
  }

  ChildResult render(const std::string& aov, const std::string& file) const {
    return run_relievo({"render", (folder_ / "scene.toml").string(), "--technique", "relief", "--aov", aov, "-o",
                        (folder_ / file).string(), "--json"});
  }

  Image image(const std::string& aov, const std::string& extension) const {
    const ChildResult result = render(aov, aov + extension);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    Result<Image> loaded = load_image(folder_ / (aov + extension));
    EXPECT_TRUE(loaded) << (loaded ? "" : format(loaded.error()));
    return loaded ? *std::move(loaded) : Image{};
  }

  TemporaryFolder folder_;
};

using Pixel = std::array<double, 3>;

/// What a PNG shows of numbers, given all that were drawn of the first channel, in order.
using Shown = std::function<Pixel(const float* number, const std::vector<double>& drawn)>;

void expect_shown(const Image& numbers, const Image& picture, const Shown& shown) {
  ASSERT_EQ(numbers.channels, 4);
  ASSERT_EQ(picture.pixels.size(), static_cast<std::size_t>(width * height * picture.channels));
  std::vector<double> drawn;
  for (std::size_t i = 0; i < numbers.pixels.size(); i += 4) {
    if (numbers.pixels[i + 3] > 0) drawn.push_back(numbers.pixels[i]);
  }
  std::sort(drawn.begin(), drawn.end());
  EXPECT_GT(drawn.size(), numbers.pixels.size() / 40);
  EXPECT_LT(drawn.size(), numbers.pixels.size() / 4);
  int wrong = 0;
  for (std::size_t k = 0; k < numbers.pixels.size() / 4; ++k) {
    const float* number = &numbers.pixels[4 * k];
    const bool is_drawn = number[3] > 0;
    const Pixel expected = is_drawn ? shown(number, drawn) : Pixel{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double found = picture.pixels[static_cast<std::size_t>(picture.channels) * k + c];
      wrong += std::abs(found - std::clamp(expected[c], 0., 1.)) > 0.6 / 255;
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(RenderCli, PicturesOfNumbersShowThem) {
  const auto grey = [](double value) { return Pixel{value, value, value}; };
  const std::map<std::string, Shown> all = {
      {"depth",
       [&](const float* n, const std::vector<double>& drawn) {
         const double near = drawn[drawn.size() / 100], far = drawn[drawn.size() - 1 - drawn.size() / 100];
         return grey(1 - 0.9 * std::clamp((*n - near) / (far - near), 0., 1.));
       }},
      {"steps", [&](const float* n, const std::vector<double>& drawn) { return grey(*n / drawn.back()); }},
      {"status", [&](const float* n, const std::vector<double>&) { return grey((*n + 1) / 5); }},
      {"normal",
       [](const float* n, const std::vector<double>&) {
         return Pixel{0.5 + 0.5 * n[0], 0.5 + 0.5 * n[1], 0.5 + 0.5 * n[2]};
       }},
      {"uv",
       [](const float* n, const std::vector<double>&) {
         return Pixel{n[0] - std::floor(n[0]), n[1] - std::floor(n[1]), n[2] - std::floor(n[2])};
       }},
  };
  for (const auto& [aov, shown] : all) {
    SCOPED_TRACE(aov);
    expect_shown(image(aov, ".exr"), image(aov, ".png"), shown);
  }
}

TEST_F(RenderCli, SaysInJsonWhatItWrote) {
  const ChildResult result = render("color", "picture.png");
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  EXPECT_EQ(json.value("width", 0), width) << result.out << result.err;
  EXPECT_EQ(json.value("height", 0), height);
  EXPECT_EQ(json.value("degenerate_triangles", -1), 0);
  EXPECT_EQ(json.value("output", ""), (folder_ / "picture.png").string());
  EXPECT_TRUE(json.contains("seconds") && (json["seconds"].is_null() || json["seconds"] > 0));
}

}  // namespace
}  // namespace relievo::test
