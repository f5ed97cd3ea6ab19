// Textures through the OpenGL backend: every format, mips, 3D, filters, address modes, storage.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "opengl_jobs.hpp"

namespace relievo {
namespace {

using namespace opengl_jobs;
using testing::ElementsAre;
using testing::Pointwise;
using testing::SizeIs;

const std::vector<Format> all_formats = {
    Format::r8_unorm,    Format::rg8_unorm,    Format::rgb8_unorm,   Format::rgba8_unorm, Format::r16_unorm,
    Format::rg16_unorm,  Format::rgb16_unorm,  Format::rgba16_unorm, Format::r32_float,   Format::rg32_float,
    Format::rgb32_float, Format::rgba32_float, Format::r32_uint,     Format::rgba16_uint, Format::d32_float};

int bits_per_channel(Format format) {
  return 8 * bytes_per_texel(format) / channel_count(format);
}
bool is_float(Format format) {
  return bits_per_channel(format) == 32 && !is_integer(format);
}

Texture make_texture(Format format, int width, int height) {
  Texture texture;
  texture.name = std::string(to_string(format));
  texture.format = format;
  texture.width = width;
  texture.height = height;
  texture.sampler.min_mag = TexelFilter::nearest;
  return texture;
}

/// Distinct, repeatable contents; floats in [0,1], because depth is.
std::vector<std::byte> noise(Format format, std::size_t bytes) {
  std::uint32_t state = 12345;
  const auto next = [&state] { return state = state * 1664525u + 1013904223u; };
  if (is_float(format)) {
    std::vector<float> values(bytes / 4);
    for (float& value : values) value = static_cast<float>(next() >> 8) * 0x1p-24f;
    return to_bytes(values);
  }
  std::vector<std::byte> values(bytes);
  for (std::byte& value : values) value = static_cast<std::byte>(next() >> 24);
  return values;
}

double decode(Format format, const std::byte* channel) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, channel, static_cast<std::size_t>(bits_per_channel(format) / 8));
  if (is_float(format)) {
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  return is_integer(format) ? bits : bits / (std::exp2(bits_per_channel(format)) - 1);
}

/// What texelFetch gives for each texel: four channels, missing ones 0, 0, 1.
std::vector<double> expected_texels(Format format, const std::vector<std::byte>& data) {
  const std::size_t step = static_cast<std::size_t>(bits_per_channel(format) / 8);
  std::vector<double> texels;
  for (std::size_t at = 0; at < data.size(); at += static_cast<std::size_t>(bytes_per_texel(format))) {
    for (int c = 0; c < 4; ++c) {
      const std::size_t offset = at + step * static_cast<std::size_t>(c);
      texels.push_back(c < channel_count(format) ? decode(format, &data[offset]) : c == 3 ? 1.0 : 0.0);
    }
  }
  return texels;
}

/// Channels that differ by more than rounding: conversion to float may be off by an ulp.
int mismatches(const std::vector<double>& expected, const std::vector<double>& given) {
  if (expected.size() != given.size()) return -1;
  int count = 0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    count += std::abs(expected[i] - given[i]) > 1e-7 * std::abs(expected[i]);
  return count;
}

Job fetch_job(const Texture& texture) {
  const bool is_uint = is_integer(texture.format);
  const std::string vec = is_uint ? "uvec4" : "vec4";
  Job job = compute_job("layout(local_size_x = 1) in;\nlayout(std430) buffer Out { " + vec + " v[]; };\nuniform " +
                            (is_uint ? "usampler2D" : "sampler2D") +
                            " map;\n"
                            "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
                            "  v[p.y * gl_NumWorkGroups.x + p.x] = texelFetch(map, p, 0); }",
                        16 * static_cast<std::size_t>(texture.width * texture.height));
  sample_texture(job, "map", texture);
  std::get<Dispatch>(job.commands[0]).groups = {static_cast<std::uint32_t>(texture.width),
                                                static_cast<std::uint32_t>(texture.height), 1};
  job.read_backs.push_back({ReadBack::Source::texture, 0, 0});
  return job;
}

std::vector<double> fetched_texels(const Texture& texture, const JobResult& result) {
  const auto& bytes = result.read_backs.at(0);
  if (is_integer(texture.format)) {
    const auto values = from_bytes<std::uint32_t>(bytes);
    return {values.begin(), values.end()};
  }
  const auto values = from_bytes<float>(bytes);
  return {values.begin(), values.end()};
}

TEST(OpenGlTexture, EveryFormatIsSampledAndReadBack) {
  const auto backend = open_opengl();
  for (const Format format : all_formats) {
    SCOPED_TRACE(to_string(format));
    Texture texture = make_texture(format, 5, 3);  // odd rows: 5 texels of 1 or 3 bytes are not aligned to 4
    texture.data = {noise(format, level_size(texture, 0))};
    const JobResult result = run(*backend, fetch_job(texture));
    ASSERT_THAT(result.read_backs, SizeIs(2));
    EXPECT_EQ(mismatches(expected_texels(format, texture.data[0]), fetched_texels(texture, result)), 0);
    EXPECT_EQ(result.read_backs[1], texture.data[0]);
  }
}

TEST(OpenGlTexture, TheFormatCheckSeesTwoLevelsOf255) {
  Texture texture = make_texture(Format::rgb8_unorm, 5, 3);
  texture.data = {noise(texture.format, level_size(texture, 0))};
  Texture faulty = texture;
  faulty.data[0][17] = static_cast<std::byte>(static_cast<int>(faulty.data[0][17]) ^ 2);
  const JobResult result = run(fetch_job(faulty));
  EXPECT_EQ(mismatches(expected_texels(texture.format, texture.data[0]), fetched_texels(texture, result)), 1);
  EXPECT_NE(result.read_backs[1], texture.data[0]);
}

TEST(OpenGlTexture, TexturesWithoutDataAreZero) {
  const auto backend = open_opengl();
  for (const Format format : all_formats) {
    const Texture texture = make_texture(format, 5, 3);
    const JobResult result = run(*backend, fetch_job(texture));
    EXPECT_EQ(result.read_backs[1], std::vector<std::byte>(level_size(texture, 0))) << to_string(format);
  }
}

/// Samples at `count` places that the expression of `i` (0-based) gives and returns the red channel.
std::vector<float> sample(const Texture& texture, const std::string& expression, int count) {
  const std::string type = texture.is_3d ? "sampler3D" : "sampler2D";
  Job job = compute_job("layout(local_size_x = 1) in;\nlayout(std430) buffer Out { float v[]; };\nuniform " + type +
                            " map;\nvoid main() { float i = float(gl_GlobalInvocationID.x);\n"
                            "  v[gl_GlobalInvocationID.x] = " +
                            expression + ".r; }",
                        4 * static_cast<std::size_t>(count));
  sample_texture(job, "map", texture);
  std::get<Dispatch>(job.commands[0]).groups[0] = static_cast<std::uint32_t>(count);
  const JobResult result = run(job);
  return result.read_backs.empty() ? std::vector<float>{} : from_bytes<float>(result.read_backs.at(0));
}

/// A float texture whose texels count from 0, in memory order.
Texture counting_texture(int width, int height, int depth = 1, bool is_3d = false) {
  Texture texture = make_texture(Format::r32_float, width, height);
  texture.depth = depth;
  texture.is_3d = is_3d;
  std::vector<float> values;
  for (int i = 0; i < width * height * depth; ++i) values.push_back(static_cast<float>(i));
  texture.data = {to_bytes(values)};
  return texture;
}

Texture mipmapped_texture() {
  Texture texture = make_texture(Format::r32_float, 5, 3);
  texture.levels = 3;  // 5x3, 2x1, 1x1
  for (int level = 0; level < 3; ++level) {
    texture.data.push_back(
        to_bytes(std::vector<float>(level_size(texture, level) / 4, 10.0f * static_cast<float>(level))));
  }
  return texture;
}

TEST(OpenGlTexture, LevelsOfOddSizesAreSampledApart) {
  Texture texture = mipmapped_texture();
  EXPECT_THAT(sample(texture, "textureLod(map, vec2(0.9), i)", 4), ElementsAre(0, 10, 20, 20));
  EXPECT_THAT(sample(texture, "vec4(textureSize(map, int(i)).x)", 3), ElementsAre(5, 2, 1));
  EXPECT_THAT(sample(texture, "textureLod(map, vec2(0.9), 0.25 + 0.5 * i)", 3), ElementsAre(0, 10, 10));
  texture.sampler.mip = TexelFilter::linear;
  EXPECT_THAT(sample(texture, "textureLod(map, vec2(0.9), 0.25 + 0.5 * i)", 3), ElementsAre(2.5, 7.5, 12.5));
}

TEST(OpenGlTexture, EveryLevelIsReadBack) {
  Job job;
  job.textures = {mipmapped_texture()};
  for (int level = 0; level < 3; ++level) job.read_backs.push_back({ReadBack::Source::texture, 0, level});
  EXPECT_EQ(run(job).read_backs, job.textures[0].data);
}

TEST(OpenGlTexture, LinearFilterTakesTheMeanBetweenTexelCentres) {
  Texture texture = counting_texture(4, 1);
  texture.sampler.min_mag = TexelFilter::linear;
  texture.sampler.address[0] = TexelAddress::clamp;
  EXPECT_THAT(sample(texture, "textureLod(map, vec2((i + 0.5) / 8.0, 0.5), 0.0)", 8),
              ElementsAre(0, 0.25, 0.75, 1.25, 1.75, 2.25, 2.75, 3));
}

TEST(OpenGlTexture, NearestFilterTakesTheTexelAround) {
  EXPECT_THAT(sample(counting_texture(4, 1), "textureLod(map, vec2((i + 0.5) / 8.0, 0.5), 0.0)", 8),
              ElementsAre(0, 0, 1, 1, 2, 2, 3, 3));
}

/// Texels −5..8 of a row of four.
std::vector<float> addressed(TexelAddress mode) {
  const std::vector<int> repeat = {3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0};
  const std::vector<int> mirror = {3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0, 0};
  const std::vector<int> clamp = {0, 0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3};
  const auto& texels = mode == TexelAddress::repeat ? repeat : mode == TexelAddress::mirror ? mirror : clamp;
  return {texels.begin(), texels.end()};
}

TEST(OpenGlTexture, EachAxisHasItsAddressMode) {
  const std::array<TexelAddress, 3> modes = {TexelAddress::repeat, TexelAddress::mirror, TexelAddress::clamp};
  const std::array<std::string, 3> places = {"vec3(u, 0.5, 0.5)", "vec3(0.5, u, 0.5)", "vec3(0.5, 0.5, u)"};
  for (std::size_t turn = 0; turn < 3; ++turn) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      SCOPED_TRACE(turn * 10 + axis);
      Texture texture = counting_texture(axis == 0 ? 4 : 1, axis == 1 ? 4 : 1, axis == 2 ? 4 : 1, true);
      for (std::size_t k = 0; k < 3; ++k) texture.sampler.address[k] = modes[(k + turn) % 3];
      std::string place = places[axis];
      place.replace(place.find('u'), 1, "(i - 4.5) / 4.0");
      EXPECT_EQ(sample(texture, "textureLod(map, " + place + ", 0.0)", 14), addressed(modes[(axis + turn) % 3]));
    }
  }
}

TEST(OpenGlTexture, Textures3DAreInMemoryOrder) {
  Texture texture = counting_texture(2, 3, 4, true);
  std::vector<float> all(24);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<float>(i);
  EXPECT_EQ(sample(texture, "texelFetch(map, ivec3(int(i) % 2, int(i) / 2 % 3, int(i) / 6), 0)", 24), all);
  texture.sampler.min_mag = TexelFilter::linear;
  EXPECT_THAT(sample(texture, "textureLod(map, vec3(0.25, 0.5 / 3.0, (i + 1.0) / 4.0), 0.0)", 3),
              ElementsAre(3, 9, 15));
}

Job store_job(Format format, const std::string& qualifier, const std::string& image, bool is_3d) {
  const std::string place = is_3d ? "p" : "p.xy", vec = image[0] == 'u' ? "uvec4" : "vec4";
  Job job;
  job.programs = {
      {"store",
       {make_shader(ShaderStage::compute,
                    "layout(local_size_x = 1) in;\nlayout(" + qualifier + ") uniform " + image + (is_3d ? "3D" : "2D") +
                        " map;\nvoid main() { ivec3 p = ivec3(gl_GlobalInvocationID);\n  imageStore(map, " + place +
                        ", imageLoad(map, " + place + ") + " + vec + "(p.x + 3 * p.y + 6 * p.z)); }")},
       {{ResourceKind::storage_texture, 2, 0, "map", 1}},
       {}}};
  job.textures = {make_texture(format, 3, 2)};
  job.textures[0].is_3d = is_3d;
  job.textures[0].depth = is_3d ? 4 : 1;
  const Dispatch dispatch = {0, {{2, 0, 0}}, {3, 2, is_3d ? 4u : 1u}};
  job.commands = {dispatch, dispatch};
  job.read_backs = {{ReadBack::Source::texture, 0, 0}};
  return job;
}

TEST(OpenGlTexture, StorageTexturesAreReadAndWritten) {
  for (const bool is_3d : {false, true}) {
    const std::size_t count = is_3d ? 24 : 6;
    std::vector<float> floats(count);
    std::vector<std::uint32_t> integers(count);
    for (std::size_t i = 0; i < count; ++i) {
      floats[i] = 2.0f * static_cast<float>(i);
      integers[i] = 2 * static_cast<std::uint32_t>(i);
    }
    EXPECT_EQ(run(store_job(Format::r32_float, "r32f", "image", is_3d)).read_backs.at(0), to_bytes(floats));
    EXPECT_EQ(run(store_job(Format::r32_uint, "r32ui", "uimage", is_3d)).read_backs.at(0), to_bytes(integers));
  }
}

TEST(OpenGlTexture, EveryStorageFormatStoresWhatWasThere) {
  const std::vector<std::pair<Format, std::string>> formats = {
      {Format::r8_unorm, "r8"},         {Format::rg8_unorm, "rg8"},    {Format::rgba8_unorm, "rgba8"},
      {Format::r16_unorm, "r16"},       {Format::rg16_unorm, "rg16"},  {Format::rgba16_unorm, "rgba16"},
      {Format::r32_float, "r32f"},      {Format::rg32_float, "rg32f"}, {Format::rgba32_float, "rgba32f"},
      {Format::rgba16_uint, "rgba16ui"}};
  for (const auto& [format, qualifier] : formats) {
    SCOPED_TRACE(qualifier);
    Texture texture = make_texture(format, 5, 3);
    texture.data = {noise(format, level_size(texture, 0))};
    const std::string number = is_integer(format) ? "u" : "";
    Job job = store_job(format, qualifier, number + "image", false);
    job.programs[0].shaders[0] =
        make_shader(ShaderStage::compute, "layout(local_size_x = 5, local_size_y = 3) in;\nlayout(" + qualifier +
                                              ") uniform " + number +
                                              "image2D map;\nvoid main() {\n"
                                              "  ivec2 p = ivec2(gl_GlobalInvocationID.xy), q = ivec2(4, 2) - p;\n"
                                              "  " +
                                              number +
                                              "vec4 texel = imageLoad(map, q); memoryBarrierImage(); barrier();\n"
                                              "  imageStore(map, p, texel); }");
    job.textures = {texture};
    job.commands.resize(1);
    std::get<Dispatch>(job.commands[0]).groups = {1, 1, 1};
    auto turned = texture.data[0];
    const auto size = static_cast<std::size_t>(bytes_per_texel(format));
    for (std::size_t i = 0; i < 15; ++i) std::memcpy(&turned[i * size], &texture.data[0][(14 - i) * size], size);
    EXPECT_EQ(run(job).read_backs.at(0), turned);
  }
}

}  // namespace
}  // namespace relievo
