/// Maps in files: what is written comes back bit by bit, and what is no such file is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "maps/map_layout.hpp"
#include "relievo/image.hpp"
#include "relievo/maps.hpp"
#include "support/files.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {
namespace {

struct Shape {
  int width, height, depth, levels, channels, bits;
};

/// Random texels; negative ones too where the map holds floats.
MapData random_map(const Shape& s, std::uint64_t seed = 1) {
  MapData map;
  map.name = "probe";
  map.width = s.width;
  map.height = s.height;
  map.depth = s.depth;
  map.dimension = s.depth == 1 ? MapDimension::flat : s.depth < 5 ? MapDimension::array : MapDimension::volume;
  map.levels = s.levels;
  map.channels = s.channels;
  map.address = AddressMode::mirror;
  Random random(seed);
  const std::size_t count = texel_count(map) * static_cast<std::size_t>(s.channels);
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(static_cast<float>(random.uniform(s.bits == 32 ? -3 : 0, 1)));
  map.texels = values;
  const std::vector<Rounding> rounding(static_cast<std::size_t>(s.channels), Rounding::nearest);
  EXPECT_TRUE(quantise(map, s.bits, rounding));
  map.is_uint = s.bits == 16 && s.channels == 4;
  return map;
}

void expect_same(const MapData& a, const MapData& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_EQ(a.levels, b.levels);
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.bits, b.bits);
  EXPECT_EQ(a.is_uint, b.is_uint);
  EXPECT_EQ(a.address, b.address);
  EXPECT_EQ(a.texels, b.texels);
}

const std::vector<Shape> shapes = {{7, 13, 1, 1, 1, 32},   {7, 13, 1, 1, 4, 32}, {1, 1, 1, 1, 2, 32},
                                   {16, 8, 1, 5, 1, 32},   {16, 1, 1, 5, 3, 32}, {1, 64, 1, 7, 1, 32},
                                   {5, 3, 9, 1, 2, 32},    {8, 8, 1, 4, 1, 8},   {8, 8, 1, 4, 3, 16},
                                   {3, 1200, 20, 1, 1, 8}, {7, 5, 3, 1, 4, 16},  {7, 5, 1, 1, 2, 16}};

class MapFileTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string error_id(const std::string& name, const MapData* shape = nullptr) const {
    const Result<MapFile> file = read_map(path(name), shape);
    if (file) return "";
    EXPECT_NE(file.error().message.find("expected"), std::string::npos) << file.error().message;
    EXPECT_NE(file.error().file.find(name.substr(0, name.find('.'))), std::string::npos) << "names the file";
    return file.error().id;
  }
  TemporaryFolder folder_;
};

TEST_F(MapFileTest, EveryShapeComesBackBitByBit) {
  for (const Shape& shape : shapes) {
    const MapData map = random_map(shape);
    for (const char* extension : {".exr", ".pfm", ".png"}) {
      if (std::string(extension) == ".png" && shape.bits == 32) continue;
      if (std::string(extension) == ".pfm" && shape.channels % 2 == 0) continue;
      SCOPED_TRACE(::testing::Message() << shape.width << "x" << shape.height << "x" << shape.depth << " of "
                                        << shape.bits << " bits in " << extension);
      const std::string file = path(std::string("map") + extension);
      const Status written = write_map(file, map, {{"probe.bits", shape.bits}});
      ASSERT_TRUE(written) << format(written.error());
      const Result<MapFile> read = read_map(file);
      ASSERT_TRUE(read) << format(read.error());
      expect_same(read->map, map);
      EXPECT_EQ(read->values.at("probe.bits"), shape.bits);
    }
  }
}

TEST_F(MapFileTest, AShapeStandsInForTheDescription) {
  const MapData map = random_map({16, 8, 1, 5, 1, 16});
  ASSERT_TRUE(write_map(path("map.png"), map));
  std::filesystem::remove(path("map.png.json"));
  EXPECT_EQ(error_id("map.png"), "maps.description");
  MapData shape = map;
  shape.texels = {};
  const Result<MapFile> read = read_map(path("map.png"), &shape);
  ASSERT_TRUE(read) << format(read.error());
  expect_same(read->map, map);
  shape.levels = 4;
  shape.bits = 8;
  EXPECT_EQ(error_id("map.png", &shape), "maps.bits");
  shape.bits = 32;
  EXPECT_EQ(error_id("map.png", &shape), "maps.format");
  shape.bits = 8;
  shape.channels = 2;
  EXPECT_EQ(error_id("map.png", &shape), "maps.size");
}

TEST_F(MapFileTest, PanelsCoverEveryTexelOnceAndNeverOverlap) {
  for (const Shape& s : shapes) {
    const MapData map = random_map(s);
    const MapLayout layout = map_layout(map);
    std::vector<int> covered(static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height), 0);
    std::vector<int> texels(texel_count(map), 0);
    for (const MapPanel& p : layout.panels) {
      ASSERT_LE(p.x + p.width, layout.width);
      ASSERT_LE(p.y + p.height, layout.height);
      for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) {
          ++covered[static_cast<std::size_t>(p.y + y) * static_cast<std::size_t>(layout.width) +
                    static_cast<std::size_t>(p.x + x)];
          ++texels[p.offset + static_cast<std::size_t>(y * p.width + x)];
        }
    }
    EXPECT_EQ(*std::max_element(covered.begin(), covered.end()), 1);
    EXPECT_EQ(std::count(texels.begin(), texels.end(), 1), static_cast<std::ptrdiff_t>(texels.size()));
    EXPECT_LE(layout.height, max_image_extent);
  }
}

TEST_F(MapFileTest, OneChangedTexelIsSeen) {
  const MapData map = random_map({8, 8, 1, 4, 1, 8});
  ASSERT_TRUE(write_map(path("map.png"), map));
  Result<Image> image = load_image(path("map.png"));
  ASSERT_TRUE(image);
  image->pixels[static_cast<std::size_t>(8)] += image->pixels[8] > 0.5f ? -1 / 255.0f : 1 / 255.0f;  // level 1's first
  ASSERT_TRUE(write_png(path("map.png"), *image));
  const Result<MapFile> read = read_map(path("map.png"));
  ASSERT_TRUE(read) << format(read.error());
  EXPECT_NE(read->map.texels[64], map.texels[64]);
  for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(read->map.texels[i], map.texels[i]);
}

TEST_F(MapFileTest, BrokenFilesAreRefused) {
  const MapData map = random_map({16, 8, 1, 5, 1, 16});
  for (const char* name : {"map.png", "map.exr", "map.pfm"}) {
    ASSERT_TRUE(write_map(path(name), map));
    const std::string whole = TemporaryFolder::read(path(name));
    folder_.write(name, whole.substr(0, whole.size() * 2 / 3));
    const Result<MapFile> truncated = read_map(path(name));
    ASSERT_FALSE(truncated) << name;
    EXPECT_TRUE(truncated.error().id.starts_with("image.")) << format(truncated.error());
    folder_.write(name, "");
    EXPECT_FALSE(read_map(path(name))) << name;
  }
  ASSERT_TRUE(write_map(path("map.pfm"), map));
  ASSERT_TRUE(write_pfm(path("map.pfm"), Image{24, 7, 1, std::vector<float>(24 * 7)}));
  EXPECT_EQ(error_id("map.pfm"), "maps.size");
  std::vector<float> pixels(24 * 8);
  pixels[3] = std::nanf("");
  ASSERT_TRUE(write_pfm(path("map.pfm"), Image{24, 8, 1, pixels}));
  EXPECT_EQ(error_id("map.pfm"), "maps.non-finite");
  pixels[3] = 0.3f;
  ASSERT_TRUE(write_pfm(path("map.pfm"), Image{24, 8, 1, pixels}));
  EXPECT_EQ(error_id("map.pfm"), "maps.bits");
}

TEST_F(MapFileTest, DescriptionsThatAreNoneAreRefused) {
  const MapData map = random_map({16, 8, 1, 5, 1, 16});
  ASSERT_TRUE(write_map(path("map.png"), map));
  const nlohmann::json good = nlohmann::json::parse(TemporaryFolder::read(path("map.png.json")));
  const auto refused = [&](const std::string& text) {
    folder_.write("map.png.json", text);
    const Result<MapFile> file = read_map(path("map.png"));
    return !file && file.error().id == "maps.description" && file.error().file == path("map.png.json");
  };
  EXPECT_FALSE(refused(good.dump()));
  EXPECT_TRUE(refused(""));
  EXPECT_TRUE(refused("{"));
  EXPECT_TRUE(refused("[1, 2]"));
  for (const auto& [key, value] : good.items()) {
    nlohmann::json bad = good;
    bad.erase(key);
    EXPECT_TRUE(refused(bad.dump())) << "without " << key;
    bad[key] = nlohmann::json::array({-1});
    EXPECT_TRUE(refused(bad.dump())) << key << " of another type";
  }
  const std::pair<const char*, nlohmann::json> faults[] = {
      {"width", 0},        {"levels", 4294967301},  // 5 in 32 bits
      {"channels", 1e300}, {"bits", 16.5},         {"height", 1 << 20},
      {"layers", -1},      {"levels", 40},         {"channels", 5},
      {"bits", 9},         {"schema", 2},          {"texels", "int"},
      {"texels", "uint"},  // has one channel
      {"address", "wrap"}, {"dimension", "4d"},    {"values", {{"a", "b"}}}};
  for (const auto& [key, value] : faults) {
    nlohmann::json bad = good;
    bad[key] = value;
    EXPECT_TRUE(refused(bad.dump())) << key << " = " << value;
  }
}

TEST_F(MapFileTest, AFormatThatWouldLoseSomethingIsRefused) {
  const auto id = [&](const Shape& shape, const std::string& name) {
    const Status status = write_map(path(name), random_map(shape));
    return status ? "" : status.error().id;
  };
  EXPECT_EQ(id({4, 4, 1, 1, 1, 32}, "map.png"), "maps.format");
  EXPECT_EQ(id({4, 4, 1, 1, 2, 32}, "map.pfm"), "maps.format");
  EXPECT_EQ(id({4, 4, 1, 1, 1, 32}, "map.tiff"), "maps.format");
  EXPECT_EQ(id({4, 4, 1, 1, 1, 32}, "none/map.exr"), "image.write");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path())) << "leaves something behind";
}

}  // namespace
}  // namespace relievo::test
