/// `relievo bake` and `relievo certify`: a map goes to a file and back, and a single wrong texel is found.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "relievo/image.hpp"
#include "support/child.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {
namespace {

class CertifyCli : public ::testing::Test {
 protected:
  void SetUp() override {
    const HeightMap map = smooth_noise_map(12, 7);
    ASSERT_TRUE(write_pfm(folder_ / "height.pfm", Image{map.width, map.height, 1, map.texels}));
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  void bake(const std::string& file, std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"bake", "max_pyramid", "--height", path("height.pfm"), "-o", path(file)};
    words.insert(words.end(), more.begin(), more.end());
    const ChildResult result = run_relievo(words);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  ChildResult certify(std::vector<std::string> more) const {
    std::vector<std::string> words = {"certify", "max_pyramid", "--height", path("height.pfm")};
    words.insert(words.end(), more.begin(), more.end());
    return run_relievo(words);
  }
  void expect_refused(std::vector<std::string> more, const std::vector<std::string>& parts) const {
    const ChildResult result = certify(std::move(more));
    EXPECT_EQ(result.exit_code, 1) << result.err << result.out;
    for (const std::string& part : parts) EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
  }
  TemporaryFolder folder_;
};

TEST_F(CertifyCli, ABakedMapKeepsItsPromiseInEveryFormat) {
  for (const auto& [file, bits] : std::map<std::string, std::string>{
           {"p.exr", "32"}, {"p.pfm", "32"}, {"q.pfm", "8"}, {"p8.png", "8"}, {"p16.png", "16"}}) {
    bake(file, {"--set", "bits=" + bits, "--address", "mirror"});
    const ChildResult result = certify({"--map", path(file), "--json"});
    EXPECT_EQ(result.exit_code, 0) << file << result.err;
    const auto json = nlohmann::json::parse(result.out, nullptr, false);
    EXPECT_EQ(json.value("violations", -1), 0) << result.out;
    EXPECT_EQ(json.value("checked", 0), 12 * 7 * 5) << "cells times levels";
  }
}

/// The buffers and textures of the largest Job: the height map, the pyramid, and one small block a level.
TEST_F(CertifyCli, BakingSaysWhatItTakesOnTheDevice) {
  const ChildResult result =
      run_relievo({"bake", "max_pyramid", "--height", path("height.pfm"), "-o", path("p.exr"), "--json"});
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  const int pyramid = 4 * (16 * 8 + 8 * 4 + 4 * 2 + 2 * 1 + 1);
  EXPECT_EQ(json.value("bytes", 0), pyramid) << result.out << result.err;
  EXPECT_EQ(json.value("peak_device_bytes", 0), pyramid + 4 * 12 * 7 + 5 * 64) << result.out;
  EXPECT_TRUE(json.contains("peak_process_bytes") && json.contains("command_seconds")) << result.out;
}

TEST_F(CertifyCli, WithoutAFileTheMapIsBakedFirst) {
  for (const char* backend : {"vulkan", "opengl"}) {
    const ChildResult result = certify({"--backend", backend, "--set", "bits=8", "--address", "clip"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("420 checked, 0 violations"), std::string::npos) << result.out;
  }
}

TEST_F(CertifyCli, OneLoweredTexelIsFoundAndNamed) {
  bake("p.pfm");
  Result<Image> image = load_image(path("p.pfm"));
  ASSERT_TRUE(image);
  ASSERT_EQ(image->width, 24);
  image->pixels[static_cast<std::size_t>(2 * 24 + 16 + 5)] -= 0.5f;  // level 1 begins at the pixel (16, 0)
  ASSERT_TRUE(write_pfm(path("p.pfm"), *image));
  const ChildResult result = certify({"--map", path("p.pfm"), "--json"});
  EXPECT_EQ(result.exit_code, 4) << result.out;
  EXPECT_NE(result.err.find("certify.violations"), std::string::npos) << result.err;
  const auto json = nlohmann::json::parse(result.out, nullptr, false);
  ASSERT_TRUE(json.contains("texel")) << result.out;
  EXPECT_EQ(json["texel"], nlohmann::json({{"x", 5}, {"y", 2}, {"level", 1}, {"layer", 0}}));
  EXPECT_NEAR(json.value("worst", 0.0), 0.5, 0.05);
  EXPECT_EQ(certify({"--map", path("p.pfm"), "--tolerance", "0.6"}).exit_code, 0);
}

TEST_F(CertifyCli, AFileOfAnotherMapIsRefused) {
  bake("p.exr");
  const ChildResult other = run_relievo({"certify", "cone", "--height", path("height.pfm"), "--map", path("p.exr")});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("[certify.other-map]"), std::string::npos) << other.err;
  EXPECT_NE(other.err.find("holds map 'max_pyramid'; expected 'cone'"), std::string::npos) << other.err;
}

TEST_F(CertifyCli, FilesThatAreNotThatMapAreRefused) {
  bake("p.exr");
  expect_refused({"--map", path("p.exr"), "--address", "clip"}, {"p.exr", "clip", "repeat"});
  expect_refused({"--map", path("p.exr"), "--set", "bits=8"}, {"p.exr", "max_pyramid.bits=8", "32"});
  expect_refused({"--map", path("missing.exr")}, {"missing.exr"});
  const std::string whole = TemporaryFolder::read(path("p.exr"));
  folder_.write("p.exr", whole.substr(0, whole.size() / 2));
  expect_refused({"--map", path("p.exr")}, {"p.exr", "[image."});
  ASSERT_TRUE(write_exr(path("p.exr"), Image{12, 7, 1, std::vector<float>(84)}));
  expect_refused({"--map", path("p.exr")}, {"12x7", "expected 24x8", "[maps.size]"});
  std::filesystem::remove(path("p.exr.json"));
  expect_refused({"--map", path("p.exr")}, {"[maps.size]"});
  expect_refused({"--map", path("p.exr"), "--set", "bits=9000"}, {"bits", "8 to 32"});
  bake("other.exr");
  const HeightMap larger = smooth_noise_map(40, 7);
  ASSERT_TRUE(write_pfm(folder_ / "height.pfm", Image{larger.width, larger.height, 1, larger.texels}));
  expect_refused({"--map", path("other.exr")}, {"16x8", "64x8", "[certify.shape]"});
}

}  // namespace
}  // namespace relievo::test
