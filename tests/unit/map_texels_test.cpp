// Texels in 8, 16 and 32 bits read as the floats that they stand for.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "relievo/maps.hpp"

namespace relievo {
namespace {

TEST(MapTexels, EveryValueOfTheBitsReadsAsItsMultipleAndComesBack) {
  for (const int bits : {8, 16}) {
    const int most = (1 << bits) - 1;
    std::vector<float> values;
    for (int k = 0; k <= most; ++k) values.push_back(static_cast<float>(k / static_cast<double>(most)));
    const MapTexels texels(values, bits);
    EXPECT_EQ(texels.bits(), bits);
    EXPECT_EQ(texels.floats(), values);
    EXPECT_EQ(MapTexels(texels.floats(), bits), texels);
  }
}

TEST(MapTexels, ValuesBetweenGoToTheNearestAndOthersToTheEnds) {
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values = {1.4f / 255, 1.6f / 255, -0.1f, 1.1f, infinity, -infinity, nan};
  EXPECT_EQ(MapTexels(values, 8), MapTexels(MapTexels::Values(std::vector<std::uint8_t>{1, 2, 0, 255, 255, 0, 0})));
}

TEST(MapTexels, FloatsStayAsTheyAre) {
  const std::vector<float> values = {-3.0f, 0.1f, std::numeric_limits<float>::denorm_min()};
  const MapTexels texels(values);
  EXPECT_EQ(texels.bits(), 32);
  EXPECT_EQ(texels.floats(), values);
  EXPECT_EQ(MapTexels(values, 32), texels);
}

TEST(MapTexels, ASetValueIsRoundedAndNoOtherChanges) {
  MapTexels texels(std::vector<float>{0.0f, 0.5f, 1.0f}, 16);
  texels.set(1, 0.25f);
  EXPECT_EQ(texels[0], 0.0f);
  EXPECT_NEAR(texels[1], 0.25f, 0.5 / 65535);
  EXPECT_NE(texels[1], 0.25f);
  EXPECT_EQ(texels[2], 1.0f);
}

MapData three_channels(MapTexels texels, int bits) {
  MapData map;
  map.name = "probe";
  map.width = 2;
  map.channels = 3;
  map.height = 1;
  map.texels = std::move(texels);
  map.bits = bits;
  return map;
}

/// Three channels take four in a texture; the last is 0.
TEST(MapTexels, ATextureHasTheirBytes) {
  const std::vector<float> values = {0, 0.2f, 0.4f, 0.6f, 0.8f, 1};
  const Texture texture = map_texture(three_channels(MapTexels(values, 8), 8));
  const std::vector<std::uint8_t> expected = {0, 51, 102, 0, 153, 204, 255, 0};
  ASSERT_EQ(texture.data.front().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(std::to_integer<std::uint8_t>(texture.data.front()[i]), expected[i]) << i;
}

TEST(MapTexels, FloatsOfAMapOfFewerBitsAreRoundedInItsTexture) {
  const std::vector<float> values = {0, 0.2f, 0.4f, 0.6f, 0.8f, 1};
  EXPECT_EQ(map_texture(three_channels(values, 16)).data, map_texture(three_channels(MapTexels(values, 16), 16)).data);
}

TEST(MapTexels, ATextureOfWholeNumbersIsNotFiltered) {
  MapData map = three_channels(MapTexels(std::vector<float>{0, 0.2f, 0.4f, 1, 0, 0, 0, 0}, 16), 16);
  map.channels = 4;
  EXPECT_EQ(map_texture(map).format, Format::rgba16_unorm);
  EXPECT_EQ(map_texture(map).sampler.min_mag, TexelFilter::linear);
  const Texture unorm = map_texture(map);
  map.is_uint = true;
  EXPECT_EQ(map_texture(map).format, Format::rgba16_uint);
  EXPECT_EQ(map_texture(map).sampler.min_mag, TexelFilter::nearest);
  EXPECT_EQ(map_texture(map).data, unorm.data);
}

TEST(MapTexels, ChannelsAreRoundedByTheirOwnRules) {
  MapData map = three_channels(std::vector<float>{0.5f, 0.5f, 0.5f, 0.1f, 0.1f, 0.1f}, 32);
  const std::vector<Rounding> rounding = {Rounding::up, Rounding::down, Rounding::nearest};
  ASSERT_TRUE(quantise(map, 8, rounding));
  EXPECT_EQ(map.texels, MapTexels(MapTexels::Values(std::vector<std::uint8_t>{128, 127, 128, 26, 25, 26})));
}

TEST(MapTexels, ValuesBeyondOneAreNotQuantised) {
  const std::vector<Rounding> rounding(3, Rounding::nearest);
  for (const float value : {1.5f, -0.25f}) {
    MapData map = three_channels(std::vector<float>{0.5f, 0.5f, 0.5f, 0.1f, value, 0.1f}, 32);
    const Status refused = quantise(map, 8, rounding);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().id, "maps.range");
    EXPECT_NE(refused.error().message.find("at element 4"), std::string::npos) << refused.error().message;
    EXPECT_TRUE(quantise(map, 32, rounding)) << "floats have no range";
  }
}

TEST(MapTexels, AHeightFormatThatNobodyHasIsRefused) {
  const MapData height = map_set(HeightMap{1, 1, {0.5f}}).at("height");
  for (const char* format : {"red", "alpha", "red_green"}) EXPECT_TRUE(height_texture(height, format)) << format;
  const Result<Texture> refused = height_texture(height, "blue");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().id, "maps.height-format");
  EXPECT_NE(refused.error().message.find("'blue'"), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace relievo
