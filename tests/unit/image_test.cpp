#include "relievo/image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "relievo/height_map.hpp"
#include "support/files.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {
namespace {

using ::testing::HasSubstr;

Image random_image(int width, int height, int channels) {
  Image image{width, height, channels, {}};
  Random random(static_cast<std::uint64_t>(width * 100 + height * 10 + channels));
  for (int i = 0; i < width * height * channels; ++i) image.pixels.push_back(static_cast<float>(random.uniform(-2, 3)));
  return image;
}

/// Where two images first differ in any bit, or nothing.
std::optional<std::string> difference(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) return "shape";
  if (a.pixels.size() != b.pixels.size()) return "size";
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (std::bit_cast<std::uint32_t>(a.pixels[i]) != std::bit_cast<std::uint32_t>(b.pixels[i])) {
      return "value " + std::to_string(i);
    }
  }
  return std::nullopt;
}

Image loaded(const std::filesystem::path& path) {
  auto image = load_image(path);
  EXPECT_TRUE(image.has_value()) << format(image.error());
  return image ? *image : Image{};
}

HeightMap height_map(const std::filesystem::path& path) {
  auto map = load_height_map(path);
  EXPECT_TRUE(map.has_value()) << format(map.error());
  return map ? *map : HeightMap{};
}

constexpr std::array<std::array<int, 2>, 5> sizes = {{{1, 1}, {7, 1}, {1, 9}, {33, 17}, {64, 70}}};

TEST(Image, DifferenceCatchesOneBit) {
  const Image image = random_image(5, 4, 3);
  Image faulty = image;
  faulty.pixels[17] = std::nextafter(faulty.pixels[17], 9.0f);
  EXPECT_EQ(difference(image, image), std::nullopt);
  EXPECT_EQ(difference(image, faulty), "value 17");
}

TEST(Image, ExrKeepsEveryBit) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : sizes) {
    for (int channels = 1; channels <= 4; ++channels) {
      const Image image = random_image(width, height, channels);
      ASSERT_TRUE(write_exr(folder / "a.exr", image));
      EXPECT_EQ(difference(image, loaded(folder / "a.exr")), std::nullopt) << width << "x" << height << "x" << channels;
    }
  }
}

TEST(Image, PfmKeepsEveryBit) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : sizes) {
    for (const int channels : {1, 3}) {
      const Image image = random_image(width, height, channels);
      ASSERT_TRUE(write_pfm(folder / "a.pfm", image));
      EXPECT_EQ(difference(image, loaded(folder / "a.pfm")), std::nullopt) << width << "x" << height << "x" << channels;
    }
  }
}

TEST(Image, FloatFilesKeepNanAndInf) {
  const TemporaryFolder folder;
  Image image = random_image(3, 2, 1);
  image.pixels[1] = std::numeric_limits<float>::infinity();
  image.pixels[4] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(write_exr(folder / "a.exr", image) && write_pfm(folder / "a.pfm", image));
  EXPECT_EQ(difference(image, loaded(folder / "a.exr")), std::nullopt);
  EXPECT_EQ(difference(image, loaded(folder / "a.pfm")), std::nullopt);
}

TEST(Image, PfmRowZeroIsTheLastOfTheFile) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_pfm(folder / "a.pfm", Image{1, 2, 1, {0.25f, 0.75f}}));
  const ByteString file = TemporaryFolder::read(folder / "a.pfm");
  EXPECT_EQ(file.substr(file.size() - 4), little(std::bit_cast<std::uint32_t>(0.25f), 4));
}

TEST(Image, BigEndianPfmIsSwapped) {
  const TemporaryFolder folder;
  const ByteString file = "Pf\n2 1\n1.0\n" + big(std::bit_cast<std::uint32_t>(0.5f), 4) + big(0, 4);
  EXPECT_EQ(loaded(folder.write("a.pfm", file)).pixels, (std::vector<float>{0.5f, 0.0f}));
}

TEST(Image, PngRoundsAndClamps) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Image image{7, 1, 1, {-1.0f, 0.0f, 0.5f / 255.0f, 0.49f / 255.0f, 1.0f, 7.0f, nan}};
  ASSERT_TRUE(write_png(folder / "a.png", image));
  const std::vector<float> expected = {0.0f, 0.0f, 1 / 255.0f, 0.0f, 1.0f, 1.0f, 0.0f};
  EXPECT_EQ(loaded(folder / "a.png").pixels, expected);
}

TEST(Image, PngKeepsBytesOfAllChannelCounts) {
  const TemporaryFolder folder;
  for (int channels = 1; channels <= 4; ++channels) {
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(5 * 3 * channels));
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(i * 37);
    ASSERT_TRUE(write_png(folder / "a.png", 5, 3, channels, pixels));
    const Image image = loaded(folder / "a.png");
    ASSERT_EQ(image.pixels.size(), pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) EXPECT_EQ(image.pixels[i], static_cast<float>(pixels[i] / 255.0));
  }
}

TEST(Image, WritersRejectSizesThatDisagree) {
  const TemporaryFolder folder;
  const Image image{2, 2, 1, {0, 0, 0}};
  EXPECT_EQ(write_png(folder / "a.png", image).error().id, "image.size");
  EXPECT_EQ(write_pfm(folder / "a.pfm", image).error().id, "image.size");
  EXPECT_EQ(write_exr(folder / "a.exr", image).error().id, "image.size");
  EXPECT_EQ(write_pfm(folder / "a.pfm", Image{1, 1, 2, {0, 0}}).error().id, "image.size");
  EXPECT_EQ(folder.count(), 0u);
}

TEST(Image, FailedWriteLeavesNothingBehind) {
  const TemporaryFolder folder;
  const Image image{1, 1, 1, {0.5f}};
  std::filesystem::create_directory(folder / "taken");
  const auto missing = write_png(folder.path() / "no-such-folder" / "a.png", image);
  const auto taken = write_exr(folder / "taken", image);
  ASSERT_FALSE(missing.has_value() || taken.has_value());
  EXPECT_EQ(missing.error().id, "image.write");
  EXPECT_THAT(missing.error().message, HasSubstr("'a.png' cannot be written: No such file"));
  EXPECT_EQ(taken.error().id, "image.write");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(Image, WriteReplacesAndLeavesNoTemporaryFile) {
  const TemporaryFolder folder;
  folder.write("a.png", "old");
  ASSERT_TRUE(write_png(folder / "a.png", Image{1, 1, 1, {1.0f}}));
  EXPECT_EQ(folder.count(), 1u);
  EXPECT_EQ(loaded(folder / "a.png").pixels, std::vector<float>{1.0f});
}

TEST(HeightFile, SixteenBitGreyIsExact) {
  const TemporaryFolder folder;
  const HeightMap map =
      height_map(folder.write("a.png", png(3, 1, 16, PngColour::grey, {big(0, 2) + big(0x1234, 2) + big(0xffff, 2)})));
  EXPECT_EQ(map.texels, (std::vector<float>{0.0f, static_cast<float>(0x1234 / 65535.0), 1.0f}));
}

TEST(HeightFile, RowZeroIsTheTopOfEveryFormat) {
  const TemporaryFolder folder;
  const Image image{1, 2, 1, {0.0f, 1.0f}};
  ASSERT_TRUE(write_png(folder / "a.png", image) && write_pfm(folder / "a.pfm", image) &&
              write_exr(folder / "a.exr", image));
  folder.write("a.npy", npy("<f4", "(2, 1)", little(0, 4) + little(std::bit_cast<std::uint32_t>(1.0f), 4)));
  for (const char* name : {"a.png", "a.pfm", "a.exr", "a.npy"}) {
    EXPECT_EQ(height_map(folder / name).at(0, 0), 0.0f) << name;
    EXPECT_EQ(height_map(folder / name).at(0, 1), 1.0f) << name;
  }
}

TEST(HeightFile, OneBitAndPaletteFilesAreRead) {
  const TemporaryFolder folder;
  const HeightMap bits = height_map(folder.write("bits.png", png(8, 1, 1, PngColour::grey, {"\xa0"})));
  EXPECT_EQ(bits.texels, (std::vector<float>{1, 0, 1, 0, 0, 0, 0, 0}));
  const ByteString palette("\x00\x00\x00\x33\x33\x33\xff\x00\x00", 9);
  const HeightMap colours =
      height_map(folder.write("p.png", png(3, 1, 8, PngColour::palette, {ByteString("\0\1\2", 3)}, palette)));
  EXPECT_EQ(colours.at(0, 0), 0.0f);
  EXPECT_NEAR(colours.at(1, 0), 0.2, 1e-7);
  EXPECT_NEAR(colours.at(2, 0), 0.2126, 1e-7);
}

TEST(HeightFile, EqualChannelsAreTakenAsTheyAreAndAlphaIsIgnored) {
  const TemporaryFolder folder;
  const float value = static_cast<float>(7 / 255.0);
  const ByteString rgb("\x07\x07\x07\x00\x00\x00", 6), rgba("\x07\x07\x07\x80", 4), grey_alpha("\x07\x80", 2);
  EXPECT_EQ(height_map(folder.write("a.png", png(2, 1, 8, PngColour::rgb, {rgb}))).at(0, 0), value);
  EXPECT_EQ(height_map(folder.write("b.png", png(1, 1, 8, PngColour::rgba, {rgba}))).at(0, 0), value);
  EXPECT_EQ(height_map(folder.write("c.png", png(1, 1, 8, PngColour::grey_alpha, {grey_alpha}))).at(0, 0), value);
}

TEST(HeightFile, FloatsInTheUnitIntervalStayAndOthersAreNormalised) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_pfm(folder / "unit.pfm", Image{2, 1, 1, {0.25f, 0.5f}}));
  ASSERT_TRUE(write_pfm(folder / "wide.pfm", Image{3, 1, 1, {-10.0f, 0.0f, 30.0f}}));
  ASSERT_TRUE(write_pfm(folder / "flat.pfm", Image{2, 1, 1, {7.0f, 7.0f}}));
  EXPECT_EQ(height_map(folder / "unit.pfm").texels, (std::vector<float>{0.25f, 0.5f}));
  EXPECT_EQ(height_map(folder / "wide.pfm").texels, (std::vector<float>{0.0f, 0.25f, 1.0f}));
  EXPECT_EQ(height_map(folder / "flat.pfm").texels, (std::vector<float>{0.0f, 0.0f}));
}

TEST(HeightFile, RunLengthBmpIsRead) {
  const TemporaryFolder folder;
  const HeightMap map = height_map(folder.write("a.bmp", run_length_bmp()));
  ASSERT_EQ(map.width, 4);
  const std::array<int, 8> expected = {5, 6, 7, 0, 1, 1, 1, 2};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(map.texels[i], static_cast<float>(expected[i] / 255.0)) << i;
}

TEST(HeightFile, GzippedFileEqualsTheFile) {
  const TemporaryFolder folder;
  folder.write("a.bmp", run_length_bmp());
  folder.write("a.bmp.gz", gzip(run_length_bmp()));
  EXPECT_EQ(height_map(folder / "a.bmp.gz").texels, height_map(folder / "a.bmp").texels);
}

/// The array [[0, 4], [1, 2]] as elements of one type.
template <class T>
ByteString elements(std::array<int, 4> values, bool big_endian) {
  ByteString bytes;
  for (const int value : values) {
    if constexpr (std::is_same_v<T, float>) {
      bytes += bytes_of(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4, big_endian);
    } else if constexpr (std::is_same_v<T, double>) {
      bytes += bytes_of(std::bit_cast<std::uint64_t>(static_cast<double>(value)), 8, big_endian);
    } else {
      bytes += bytes_of(static_cast<std::uint64_t>(value), sizeof(T), big_endian);
    }
  }
  return bytes;
}

template <class T>
void expect_array(const std::string& type) {
  const TemporaryFolder folder;
  const std::vector<float> expected = {0.0f, 1.0f, 0.25f, 0.5f};
  for (const bool big_endian : {false, true}) {
    const std::string descr = (big_endian ? ">" : "<") + type;
    const ByteString rows = elements<T>({0, 4, 1, 2}, big_endian), columns = elements<T>({0, 1, 4, 2}, big_endian);
    EXPECT_EQ(height_map(folder.write("a.npy", npy(descr, "(2, 2)", rows))).texels, expected) << descr;
    EXPECT_EQ(height_map(folder.write("a.npy", npy(descr, "(2, 2)", columns, true))).texels, expected) << descr;
  }
}

TEST(HeightFile, NumpyTypesOrdersAndEndiansAreRead) {
  expect_array<std::int8_t>("i1");
  expect_array<std::int16_t>("i2");
  expect_array<std::int32_t>("i4");
  expect_array<std::int64_t>("i8");
  expect_array<std::uint8_t>("u1");
  expect_array<std::uint16_t>("u2");
  expect_array<std::uint32_t>("u4");
  expect_array<std::uint64_t>("u8");
  expect_array<float>("f4");
  expect_array<double>("f8");
}

TEST(HeightFile, ArchiveGivesItsOnlyTwoDimensionalArray) {
  const TemporaryFolder folder;
  const ByteString scalar = npy("<f8", "()", ByteString(8, '\0')), table = npy("|u1", "(1, 2)", ByteString("\0\4", 2));
  const HeightMap map = height_map(folder.write("a.npz", zip({{"dx.npy", scalar}, {"z.npy", table}})));
  EXPECT_EQ(map.width, 2);
  EXPECT_EQ(map.texels, (std::vector<float>{0.0f, 1.0f}));
}

/// Real input, with figures read from the files by an independent program (Python's zipfile, zlib and struct).
TEST(HeightFile, RealElevationModelIsRead) {
  const HeightMap map = height_map("/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz");
  ASSERT_EQ(map.width, 403);
  ASSERT_EQ(map.height, 344);
  const auto unit = [](int metres) { return static_cast<float>((metres - 236) / (1076.0 - 236.0)); };
  EXPECT_NEAR(map.at(0, 0), unit(483), 1e-7);
  EXPECT_NEAR(map.at(402, 0), unit(444), 1e-7);
  EXPECT_NEAR(map.at(0, 343), unit(545), 1e-7);
}

TEST(HeightFile, RealImagesAreRead) {
  const HeightMap asteroid = height_map("/usr/share/glmark2/textures/asteroid-height-map.png");
  EXPECT_EQ(asteroid.width, 1024);
  EXPECT_EQ(asteroid.height, 1024);
  const HeightMap crater = height_map("/usr/share/doc/povray/examples/advanced/crater/crater_dat.png");
  EXPECT_EQ(crater.width, 160);
  EXPECT_EQ(crater.at(0, 0), static_cast<float>(4220 / 65535.0));
  EXPECT_EQ(crater.at(159, 119), static_cast<float>(3510 / 65535.0));
  for (const char* name : {"terrain-heightmap.bmp.gz", "rockwall_height.bmp.gz"}) {
    const HeightMap map = height_map(std::filesystem::path("/usr/share/doc/libirrlicht-dev/media") / name);
    EXPECT_EQ(map.width, 256) << name;
    EXPECT_EQ(map.height, 256) << name;
  }
}

}  // namespace
}  // namespace relievo::test
