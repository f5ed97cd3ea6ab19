#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cstdlib>
#include <functional>
#include <limits>

#include "image/decode.hpp"
#include "relievo/height_map.hpp"
#include "relievo/image.hpp"
#include "support/files.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace relievo::test {
namespace {

using ::testing::HasSubstr;

/// Why an answer to a bad file is not the clear error it should be; empty when it is.
std::string unclear(const Result<HeightMap>& map, const std::filesystem::path& path) {
  if (map) return "it is accepted as " + std::to_string(map->width) + "x" + std::to_string(map->height);
  const Error& error = map.error();
  if (!error.id.starts_with("image.")) return "its id is " + error.id;
  if (error.code != ErrorCode::io) return "its code is not io";
  if (error.file != path.string()) return "its file is " + error.file;
  if (error.message.find(fmt::format("'{}'", path.filename().string())) == std::string::npos)
    return "no name: " + error.message;
  if (error.message.find('\n') != std::string::npos) return "several lines: " + error.message;
  return {};
}

void expect_error(const std::filesystem::path& path, const std::string& id, const std::string& part) {
  const auto map = load_height_map(path);
  EXPECT_EQ(unclear(map, path), "");
  if (map) return;
  EXPECT_EQ(map.error().id, id) << map.error().message;
  EXPECT_THAT(map.error().message, HasSubstr(part));
}

/// A picture of 13×7 in every format that is read, by file name.
std::map<std::string, ByteString> valid_files() {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> grey(13 * 7), colour(13 * 7 * 3);
  for (std::size_t i = 0; i < colour.size(); ++i) colour[i] = static_cast<std::uint8_t>(i * i * 31 + 7);
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<std::uint8_t>(i * 91 + 1);
  std::vector<float> floats(grey.begin(), grey.end()), float_colour(colour.begin(), colour.end());
  const auto at = [&](const char* name) { return (folder / name).string(); };
  stbi_write_bmp(at("a.bmp").c_str(), 13, 7, 3, colour.data());
  stbi_write_tga(at("a.tga").c_str(), 13, 7, 3, colour.data());
  stbi_write_jpg(at("a.jpg").c_str(), 13, 7, 3, colour.data(), 90);
  stbi_write_hdr(at("a.hdr").c_str(), 13, 7, 3, float_colour.data());
  EXPECT_TRUE(write_png(at("a.png"), 13, 7, 1, grey));
  EXPECT_TRUE(write_pfm(at("a.pfm"), Image{13, 7, 1, floats}));
  EXPECT_TRUE(write_exr(at("a.exr"), Image{13, 7, 1, floats}));
  const ByteString array = npy("<i2", "(7, 13)", ByteString(colour.begin(), colour.begin() + 182));
  std::map<std::string, ByteString> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    files[entry.path().filename().string()] = TemporaryFolder::read(entry.path());
  }
  files["rle.bmp"] = run_length_bmp();
  files["a.bmp.gz"] = gzip(files["a.bmp"]);
  files["rle.bmp.gz"] = gzip(run_length_bmp());
  files["a.npy"] = array;
  files["a.npz"] = zip({{"dx.npy", npy("<f8", "()", ByteString(8, '\0'))}, {"z.npy", array}});
  return files;
}

TEST(HeightFileFaults, TheCheckItselfFails) {
  EXPECT_NE(unclear(HeightMap{1, 1, {0.0f}}, "a.png"), "");
  EXPECT_NE(unclear(fail(ErrorCode::io, "image.x", "it broke", "a.png"), "a.png"), "");
  EXPECT_NE(unclear(fail(ErrorCode::io, "mesh.x", "'a.png' broke", "a.png"), "a.png"), "");
  EXPECT_EQ(unclear(fail(ErrorCode::io, "image.x", "'a.png' broke", "a.png"), "a.png"), "");
}

TEST(HeightFileFaults, ValidFilesAreAccepted) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : valid_files()) {
    const auto map = load_height_map(folder.write(name, bytes));
    EXPECT_TRUE(map.has_value()) << name << ": " << format(map.error());
  }
}

Result<HeightMap> decoded(const std::string& name, std::string_view bytes) {
  return decode_height_map({name, Bytes(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size())});
}

TEST(HeightFileFaults, EveryTruncationIsAnError) {
  for (const auto& [name, bytes] : valid_files()) {
    for (std::size_t length = 1; length < bytes.size(); ++length) {
      const std::vector<char> cut(bytes.begin(),
                                  bytes.begin() + static_cast<std::ptrdiff_t>(length));  // ends where ASan looks
      const auto map = decoded(name, {cut.data(), cut.size()});
      ASSERT_EQ(unclear(map, name), "") << name << " at " << length << " of " << bytes.size();
    }
  }
}

/// Damage need not be an error in formats without checksums, but the answer is a valid map or a clear error.
TEST(HeightFileFaults, DamagedFilesGiveAMapOrAnError) {
  for (const auto& [name, bytes] : valid_files()) {
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      for (const int flip : {0x01, 0x80, 0xff}) {
        std::vector<char> damaged(bytes.begin(), bytes.end());
        damaged[at] = static_cast<char>(damaged[at] ^ flip);
        const auto map = decoded(name, {damaged.data(), damaged.size()});
        if (!map) {
          ASSERT_EQ(unclear(map, name), "") << name << " at " << at;
          continue;
        }
        ASSERT_EQ(map->texels.size(), static_cast<std::size_t>(map->width) * static_cast<std::size_t>(map->height));
        for (const float texel : map->texels) ASSERT_TRUE(texel >= 0 && texel <= 1) << name << " at " << at;
      }
    }
  }
}

TEST(HeightFileFaults, DamagedPngFailsItsChecksum) {
  const TemporaryFolder folder;
  ByteString file = valid_files().at("a.png");
  file[file.size() / 2] = static_cast<char>(file[file.size() / 2] ^ 1);
  expect_error(folder.write("a.png", file), "image.corrupt", "wrong checksum");
}

TEST(HeightFileFaults, MissingEmptyAndFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder.png");
  expect_error(folder / "none.png", "image.missing", "does not exist");
  expect_error(folder.write("empty.png", ""), "image.empty", "is empty");
  expect_error(folder / "folder.png", "image.unreadable", "is a folder");
  expect_error(folder.write("text.png", "hello, this is no picture"), "image.format", "no known format");
}

TEST(HeightFileFaults, ColoursBeyondABmpsPaletteAreBlack) {
  const TemporaryFolder folder;
  const ByteString info = little(40, 4) + little(4, 4) + little(1, 4) + little(1, 2) + little(8, 2) + little(0, 4) +
                          little(4, 4) + ByteString(8, '\0') + little(2, 4) + little(0, 4);
  const ByteString palette = ByteString(4, '\0') + ByteString("\xff\xff\xff\0", 4);
  const ByteString bmp =
      "BM" + little(66, 4) + ByteString(4, '\0') + little(62, 4) + info + palette + "\x01\x64\x02\xff";
  const auto map = load_height_map(folder.write("short.bmp", bmp));
  ASSERT_TRUE(map) << format(map.error());
  EXPECT_EQ(map->texels, (std::vector<float>{1, 0, 0, 0}));
  // Of OS/2, whose palette stb takes for four colours shorter than it is.
  const ByteString core = little(12, 4) + little(4, 2) + little(1, 2) + little(1, 2) + little(8, 2);
  const ByteString colours = ByteString(3 * 255, '\0') + "\xff\xff\xff";
  const ByteString whole =
      "BM" + little(798, 4) + ByteString(4, '\0') + little(26 + 768, 4) + core + colours + "\xff\xfe\x01\xff";
  const auto white = load_height_map(folder.write("core.bmp", whole));
  ASSERT_TRUE(white) << format(white.error());
  EXPECT_EQ(white->texels, (std::vector<float>{1, 0, 0, 1}));
}

TEST(HeightFileFaults, HugeHeadersAreRejectedBeforeAllocation) {
  const TemporaryFolder folder;
  const ByteString info =
      little(40, 4) + little(100000, 4) + little(100000, 4) + little(1, 2) + little(24, 2) + ByteString(24, '\0');
  const ByteString bmp = "BM" + little(54, 4) + ByteString(4, '\0') + little(54, 4) + info;
  expect_error(folder.write("a.bmp", bmp), "image.size", "is 100000x100000");
  expect_error(folder.write("a.png", png(100000, 100000, 8, PngColour::grey, {ByteString(9, '\0')})), "image.size",
               "is 100000x100000; a width and height of 1 to 16384");
  expect_error(folder.write("b.png", png(0x7fffffff, 1, 16, PngColour::rgba, {ByteString(9, '\0')})), "image.size",
               "2147483647x1");
  expect_error(folder.write("a.pfm", "Pf\n100000 100000\n-1\n0000"), "image.size", "is 100000x100000");
  expect_error(folder.write("b.pfm", "Pf\n16384 16384\n-1\n0000"), "image.truncated", "cannot hold 16384x16384");
  expect_error(folder.write("c.pfm", "Pf\n-3 4\n-1\n0000"), "image.size", "is -3x4");
  expect_error(folder.write("a.npy", npy("<f8", "(100000, 100000)", "0")), "image.size", "100000 rows");
  expect_error(folder.write("b.npy", npy("<f8", "(16384, 16384)", "0")), "image.truncated", "needs 2147483648");
  const ByteString hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n0000";
  expect_error(folder.write("a.hdr", hdr), "image.size", "is 100000x100000");
  ByteString tga(18, '\0');
  tga[2] = 3;
  tga.replace(12, 6, little(65535, 2) + little(65535, 2) + little(8, 1) + ByteString(1, '\0'));
  expect_error(folder.write("a.tga", tga), "image.size", "is 65535x65535");
}

TEST(HeightFileFaults, HugeExrWindowIsRejected) {
  const TemporaryFolder folder;
  ByteString file = valid_files().at("a.exr");
  const ByteString attribute("dataWindow\0box2i\0", 17);
  const std::size_t at = file.find(attribute) + attribute.size() + 4 + 8;
  file.replace(at, 8, little(99999, 4) + little(99999, 4));
  const auto path = folder.write("a.exr", file);
  EXPECT_EQ(unclear(load_height_map(path), path), "");
}

TEST(HeightFileFaults, ExtremeShapesAreOrdinary) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::array{1, 1}, {1, 500}, {500, 1}, {16384, 1}, {1, 16384}}) {
    const std::vector<float> texels(static_cast<std::size_t>(width * height), 0.5f);
    ASSERT_TRUE(write_pfm(folder / "a.pfm", Image{width, height, 1, texels}));
    ASSERT_TRUE(write_png(folder / "a.png", Image{width, height, 1, texels}));
    ASSERT_TRUE(write_exr(folder / "a.exr", Image{width, height, 1, texels}));
    for (const char* name : {"a.pfm", "a.png", "a.exr"}) {
      const auto map = load_height_map(folder / name);
      ASSERT_TRUE(map) << format(map.error());
      EXPECT_EQ(map->width, width);
      EXPECT_EQ(map->height, height);
    }
  }
}

TEST(HeightFileFaults, NonFiniteTexelsAreNamed) {
  const TemporaryFolder folder;
  Image image{4, 3, 1, std::vector<float>(12, 0.5f)};
  image.pixels[2 * 4 + 1] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(write_pfm(folder / "nan.pfm", image) && write_exr(folder / "nan.exr", image));
  image.pixels[2 * 4 + 1] = -std::numeric_limits<float>::infinity();
  ASSERT_TRUE(write_pfm(folder / "inf.pfm", image) && write_exr(folder / "inf.exr", image));
  for (const char* name : {"nan.pfm", "nan.exr"})
    expect_error(folder / name, "image.non-finite", "NaN at texel (1, 2)");
  for (const char* name : {"inf.pfm", "inf.exr"})
    expect_error(folder / name, "image.non-finite", "Inf at texel (1, 2)");
  const ByteString nan = little(std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN()), 8);
  expect_error(folder.write("nan.npy", npy("<f8", "(2, 2)", ByteString(8, '\0') + nan + ByteString(16, '\0'))),
               "image.non-finite", "NaN at texel (1, 0)");
}

TEST(HeightFileFaults, ExtremeFloatsNormaliseWithoutOverflow) {
  const TemporaryFolder folder;
  const float largest = std::numeric_limits<float>::max();
  ASSERT_TRUE(write_pfm(folder / "a.pfm", Image{3, 1, 1, {-largest, 0.0f, largest}}));
  EXPECT_EQ(load_height_map(folder / "a.pfm")->texels, (std::vector<float>{0.0f, 0.5f, 1.0f}));
  const double huge = std::numeric_limits<double>::max();
  const ByteString elements =
      little(std::bit_cast<std::uint64_t>(-huge), 8) + little(std::bit_cast<std::uint64_t>(huge), 8);
  EXPECT_EQ(load_height_map(folder.write("a.npy", npy("<f8", "(1, 2)", elements)))->texels,
            (std::vector<float>{0.0f, 1.0f}));
}

TEST(HeightFileFaults, WrongArraysAreNamed) {
  const TemporaryFolder folder;
  const ByteString two = npy("|u1", "(1, 2)", "ab"), scalar = npy("<f8", "()", ByteString(8, '\0'));
  expect_error(folder.write("1d.npy", npy("|u1", "(2,)", "ab")), "image.format", "of 1 dimensions; 2 are expected");
  expect_error(folder.write("type.npy", npy("<c8", "(1, 1)", ByteString(8, '\0'))), "image.format", "type '<c8'");
  expect_error(folder.write("zero.npy", npy("|u1", "(0, 5)", "")), "image.size", "0 rows");
  expect_error(folder.write("shape.npy", npy("|u1", "(99999999999999999999, 5)", "")), "image.corrupt", "no shape");
  expect_error(folder.write("none.npz", zip({{"dx.npy", scalar}})), "image.format", "holds 0 two-dimensional arrays");
  expect_error(folder.write("two.npz", zip({{"a.npy", two}, {"b.npy", two}})), "image.format", "'a.npy', 'b.npy'");
  expect_error(folder.write("empty.npz", zip({{"readme.txt", "x"}})), "image.format", "holds 0");
  expect_error(folder.write("bad.npz", zip({{"a.npy", "not an array"}})), "image.corrupt", "no NumPy header");
  ByteString broken = zip({{"a.npy", two}});
  broken[broken.find("ab")] = 'x';
  expect_error(folder.write("crc.npz", broken), "image.corrupt", "in its array 'a.npy'");
}

TEST(HeightFileFaults, GzipInGzipAndGzipOfNothingKnownAreRejected) {
  const TemporaryFolder folder;
  expect_error(folder.write("a.gz", gzip(gzip("x"))), "image.format", "gzipped twice");
  expect_error(folder.write("b.gz", gzip("hello")), "image.format", "no known format");
  expect_error(folder.write("c.gz", ByteString("\x1f\x8b\x08\0\0\0\0\0\0\xff\x07", 11) + "nonsense"), "image.corrupt",
               "does not unpack");
}

/// 16 MiB of zeros in some KiB that may follow one another: a flush of all that is known ends them on a whole byte.
ByteString deflated_zeros() {
  z_stream stream = {};
  std::vector<Bytef> zeros(1u << 24), packed(1u << 20);
  if (deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY) != Z_OK) return {};
  stream.next_in = zeros.data();
  stream.avail_in = static_cast<uInt>(zeros.size());
  stream.next_out = packed.data();
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FULL_FLUSH);
  deflateEnd(&stream);
  return {packed.begin(), packed.end() - static_cast<std::ptrdiff_t>(stream.avail_out)};
}

/// Long: a GiB is unpacked and held before it is too much.
TEST(LongHeightFileFaults, AGzipBombIsRejected) {
  const TemporaryFolder folder;
  const std::size_t most = std::size_t{max_image_extent} * max_image_extent * 4 + (1u << 20);
  ByteString bomb("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10);
  const ByteString zeros = deflated_zeros();
  for (std::size_t unpacked = 0; unpacked <= most; unpacked += 1u << 24) bomb += zeros;
  EXPECT_LT(bomb.size(), most / 500);
  expect_error(folder.write("bomb.gz", bomb), "image.size",
               "unpacks to more than the " + std::to_string(most) + " bytes");
}

}  // namespace
}  // namespace relievo::test
