#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "support/jobs.hpp"

namespace relievo {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::FloatEq;
using testing::Pointwise;

constexpr Format all_formats[] = {Format::r8_unorm,  Format::rg8_unorm,   Format::rgb8_unorm,  Format::rgba8_unorm,
                                  Format::r16_unorm, Format::rg16_unorm,  Format::rgb16_unorm, Format::rgba16_unorm,
                                  Format::r32_float, Format::rg32_float,  Format::rgb32_float, Format::rgba32_float,
                                  Format::r32_uint,  Format::rgba16_uint, Format::d32_float};

/// Bytes that are all different, and for floats exact values in [0,1].
Bytes pattern(const Texture& texture, int level) {
  const std::size_t size = level_size(texture, level);
  const bool is_float = bytes_per_texel(texture.format) == 4 * channel_count(texture.format);
  if (is_float && !is_integer(texture.format)) {
    std::vector<float> values(size / sizeof(float));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * 7 % 256 + 1) / 256.0f;
    return to_bytes(values);
  }
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::byte>(i * 37 + 11 * static_cast<std::size_t>(level));
  return bytes;
}

void fill(Texture& texture) {
  for (int level = 0; level < texture.levels; ++level) texture.data.push_back(pattern(texture, level));
}

/// What a shader reads from texel `index` of a level.
std::array<float, 4> decode(const Texture& texture, const Bytes& data, std::size_t index) {
  std::array<float, 4> value = {0, 0, 0, 1};
  const auto channels = static_cast<std::size_t>(channel_count(texture.format));
  const std::size_t size = static_cast<std::size_t>(bytes_per_texel(texture.format)) / channels;
  for (std::size_t c = 0; c < channels; ++c) {
    const std::byte* bytes = data.data() + (index * channels + c) * size;
    std::uint32_t bits = 0;
    std::memcpy(&bits, bytes, size);
    if (size == 4) value[c] = std::bit_cast<float>(bits);
    if (size == 2) value[c] = static_cast<float>(bits) / (is_integer(texture.format) ? 1.0f : 65535.0f);
    if (size == 1) value[c] = static_cast<float>(bits) / 255.0f;
  }
  return value;
}

/// A job that reads texture 0 with `expression` (a vec4 of `i`) `count` times.
Job sampling_job(Texture texture, const std::string& sampler, const std::string& expression, std::uint32_t count) {
  const std::string body =
      "layout(local_size_x = 1) in;\n"
      "layout(std430, set = 0, binding = 0) buffer Result { vec4 result[]; };\n"
      "layout(set = 1, binding = 2) uniform " +
      sampler +
      " map;\n"
      "void main() { uint i = gl_GlobalInvocationID.x; result[i] = " +
      expression + "; }\n";
  Job job = make_compute_job(make_compute("sample", body, {{ResourceKind::sampled_texture, 1, 2, "map", 0}}),
                             std::size_t{16} * count);
  job.name = "sample " + std::string(to_string(texture.format));
  Dispatch& dispatch = std::get<Dispatch>(job.commands[0]);
  dispatch.resources.push_back({1, 2, 0});
  dispatch.groups[0] = count;
  job.textures = {std::move(texture)};
  return job;
}

std::vector<float> sample(Texture texture, const std::string& sampler, const std::string& expression,
                          std::uint32_t count) {
  return from_bytes<float>(run(sampling_job(std::move(texture), sampler, expression, count)).read_backs[0]);
}

std::vector<float> first_of_four(const std::vector<float>& values) {
  std::vector<float> first;
  for (std::size_t i = 0; i < values.size(); i += 4) first.push_back(values[i]);
  return first;
}

class VulkanFormat : public testing::TestWithParam<Format> {};

TEST_P(VulkanFormat, ComesBackAsItWentIn) {
  Job job;
  job.name = "round trip";
  job.textures = {make_texture("map", GetParam(), 5, 3)};
  job.textures[0].levels = 3;
  fill(job.textures[0]);
  for (int level = 0; level < 3; ++level) job.read_backs.push_back({ReadBack::Source::texture, 0, level});
  EXPECT_EQ(run(job).read_backs, job.textures[0].data);
}

TEST_P(VulkanFormat, WithoutContentsIsZero) {
  Job job;
  job.name = "blank";
  job.textures = {make_texture("map", GetParam(), 5, 3)};
  job.read_backs = {{ReadBack::Source::texture, 0, 0}};
  EXPECT_EQ(run(job).read_backs[0], Bytes(level_size(job.textures[0], 0)));
}

TEST_P(VulkanFormat, IsSampledTexelByTexel) {
  Texture texture = make_texture("map", GetParam(), 5, 3);
  fill(texture);
  const Bytes data = texture.data[0];
  if (GetParam() == Format::r32_uint) {
    const auto values = sample(texture, "usampler2D", "uintBitsToFloat(texelFetch(map, ivec2(i % 5, i / 5), 0))", 15);
    EXPECT_EQ(from_bytes<std::uint32_t>(to_bytes(first_of_four(values))), from_bytes<std::uint32_t>(data));
    return;
  }
  const auto values = sample(texture, is_integer(GetParam()) ? "usampler2D" : "sampler2D",
                             "vec4(texelFetch(map, ivec2(i % 5, i / 5), 0))", 15);
  for (std::size_t i = 0; i < 15; ++i) {
    const std::array<float, 4> expected = decode(texture, data, i);
    // Depth textures promise only their first channel.
    const std::size_t channels = GetParam() == Format::d32_float ? 1 : 4;
    for (std::size_t c = 0; c < channels; ++c) EXPECT_FLOAT_EQ(values[4 * i + c], expected[c]) << i << " " << c;
  }
}

INSTANTIATE_TEST_SUITE_P(All, VulkanFormat, testing::ValuesIn(all_formats),
                         [](const auto& test) { return std::string(to_string(test.param)); });

TEST(VulkanTexture, SamplesEveryLevel) {
  Texture texture = make_texture("map", Format::r32_float, 4, 2);
  texture.levels = 3;
  texture.data = {to_bytes(std::vector<float>(8, 1)), to_bytes(std::vector<float>(2, 2)),
                  to_bytes(std::vector<float>(1, 3))};
  EXPECT_THAT(first_of_four(sample(texture, "sampler2D", "textureLod(map, vec2(0.5), float(i))", 4)),
              ElementsAre(1, 2, 3, 3));
}

TEST(VulkanTexture, BlendsLevelsWithALinearMipFilter) {
  Texture texture = make_texture("map", Format::r32_float, 2, 2);
  texture.levels = 2;
  texture.data = {to_bytes(std::vector<float>(4, 1)), to_bytes(std::vector<float>(1, 3))};
  texture.sampler.mip = TexelFilter::linear;
  EXPECT_THAT(first_of_four(sample(texture, "sampler2D", "textureLod(map, vec2(0.5), 0.5 * float(i))", 3)),
              Pointwise(FloatEq(), {1.0f, 2.0f, 3.0f}));
}

TEST(VulkanTexture, FiltersLinearlyBetweenTexelCentres) {
  Texture texture = make_texture("map", Format::r32_float, 2, 1);
  texture.data = {to_bytes(std::vector<float>{0, 1})};
  texture.sampler.min_mag = TexelFilter::linear;
  texture.sampler.address.fill(TexelAddress::clamp);
  const auto values = first_of_four(sample(texture, "sampler2D", "textureLod(map, vec2(float(i) / 4.0, 0.5), 0.0)", 5));
  EXPECT_THAT(values, Pointwise(FloatEq(), {0.0f, 0.0f, 0.5f, 1.0f, 1.0f}));
}

/// The texels that a row of four is read as from u = −1 to u = 2, at every texel centre.
std::vector<float> addressed(TexelAddress address, int axis) {
  Texture texture =
      axis == 0 ? make_texture("map", Format::r32_float, 4, 1) : make_texture("map", Format::r32_float, 1, 4);
  texture.data = {to_bytes(std::vector<float>{0, 1, 2, 3})};
  texture.sampler.address = {TexelAddress::clamp, TexelAddress::clamp, TexelAddress::clamp};
  texture.sampler.address[static_cast<std::size_t>(axis)] = address;
  const std::string u = "(float(i) - 3.5) / 4.0";
  const std::string uv = axis == 0 ? "vec2(" + u + ", 0.5)" : "vec2(0.5, " + u + ")";
  return first_of_four(sample(texture, "sampler2D", "textureLod(map, " + uv + ", 0.0)", 12));
}

TEST(VulkanTexture, RepeatsMirrorsAndClamps) {
  for (const int axis : {0, 1}) {
    EXPECT_THAT(addressed(TexelAddress::repeat, axis), ElementsAre(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3));
    EXPECT_THAT(addressed(TexelAddress::mirror, axis), ElementsAre(3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0));
    EXPECT_THAT(addressed(TexelAddress::clamp, axis), ElementsAre(0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3));
  }
}

TEST(VulkanTexture, GathersFourTexels) {
  Texture texture = make_texture("map", Format::r32_float, 2, 2);
  texture.data = {to_bytes(std::vector<float>{1, 2, 3, 4})};
  EXPECT_THAT(sample(texture, "sampler2D", "textureGather(map, vec2(0.5))", 1), ElementsAre(3, 4, 2, 1));
}

TEST(VulkanTexture, HasThreeDimensions) {
  Texture texture = make_texture("map", Format::r8_unorm, 3, 2, 4);
  texture.levels = 2;
  fill(texture);
  const Bytes data = texture.data[0];
  Job job = sampling_job(texture, "sampler3D", "texelFetch(map, ivec3(i % 3, i / 3 % 2, i / 6), 0)", 24);
  job.read_backs.push_back({ReadBack::Source::texture, 0, 0});
  job.read_backs.push_back({ReadBack::Source::texture, 0, 1});
  const JobResult result = run(job);
  const auto values = from_bytes<float>(result.read_backs[0]);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_FLOAT_EQ(values[4 * i], decode(texture, data, i)[0]) << i;
  EXPECT_EQ(result.read_backs[1], texture.data[0]);
  EXPECT_EQ(result.read_backs[2], texture.data[1]);
}

struct StorageFormat {
  Format format;
  const char* qualifier;
};

class VulkanStorage : public testing::TestWithParam<StorageFormat> {};

TEST_P(VulkanStorage, IsWrittenThenSampledByTheNextCommand) {
  const auto [format, qualifier] = GetParam();
  const bool is_uint = is_integer(format);
  const std::string write =
      std::string(
          "layout(local_size_x = 1) in;\nlayout(std430, set = 0, binding = 0) buffer Result { uint unused; };\n") +
      "layout(set = 0, binding = 1, " + qualifier + ") uniform writeonly " + (is_uint ? "uimage2D" : "image2D") +
      " map;\n" + "void main() { imageStore(map, ivec2(gl_GlobalInvocationID.xy), " +
      (is_uint ? "uvec4(gl_GlobalInvocationID.x)" : "vec4(float(gl_GlobalInvocationID.x)) / 3.0") + "); }\n";
  Texture texture = make_texture("map", format, 4, 1);
  Job job =
      sampling_job(texture, is_uint ? "usampler2D" : "sampler2D",
                   is_uint ? "vec4(texelFetch(map, ivec2(i, 0), 0)) / 3.0" : "texelFetch(map, ivec2(i, 0), 0)", 4);
  job.programs.push_back(make_compute("store", write, {{ResourceKind::storage_texture, 0, 1, "map", 0}}));
  job.commands.insert(job.commands.begin(), Dispatch{1, {{0, 0, 0}, {0, 1, 0}}, {4, 1, 1}});
  const auto values = first_of_four(from_bytes<float>(run(job).read_backs[0]));
  ASSERT_EQ(values.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(values[i], static_cast<float>(i) / 3.0f, 0.5f / 255) << i;
}

INSTANTIATE_TEST_SUITE_P(
    All, VulkanStorage,
    testing::Values(StorageFormat{Format::r8_unorm, "r8"}, StorageFormat{Format::rg8_unorm, "rg8"},
                    StorageFormat{Format::rgba8_unorm, "rgba8"}, StorageFormat{Format::r16_unorm, "r16"},
                    StorageFormat{Format::rg16_unorm, "rg16"}, StorageFormat{Format::rgba16_unorm, "rgba16"},
                    StorageFormat{Format::r32_float, "r32f"}, StorageFormat{Format::rg32_float, "rg32f"},
                    StorageFormat{Format::rgba32_float, "rgba32f"}, StorageFormat{Format::r32_uint, "r32ui"},
                    StorageFormat{Format::rgba16_uint, "rgba16ui"}),
    [](const auto& test) { return std::string(to_string(test.param.format)); });

TEST(VulkanTexture, IsSampledAndStoredByOneCommand) {
  const std::string body = R"(
layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 0) buffer Result { float result; };
layout(set = 0, binding = 1) uniform sampler2D map;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D stored;
void main() {
  result = texelFetch(map, ivec2(0), 0).r;
  imageStore(stored, ivec2(1, 0), vec4(7.0));
}
)";
  Job job = make_compute_job(make_compute("both", body,
                                          {{ResourceKind::sampled_texture, 0, 1, "map", 0},
                                           {ResourceKind::storage_texture, 0, 2, "stored", 0}}),
                             4);
  job.textures = {make_texture("map", Format::r32_float, 2, 1)};
  job.textures[0].data = {to_bytes(std::vector<float>{5, 6})};
  std::get<Dispatch>(job.commands[0]).resources = {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}};
  job.read_backs.push_back({ReadBack::Source::texture, 0, 0});
  const JobResult result = run(job);
  EXPECT_THAT(from_bytes<float>(result.read_backs[0]), ElementsAre(5));
  EXPECT_THAT(from_bytes<float>(result.read_backs[1]), ElementsAre(5, 7));
}

}  // namespace
}  // namespace relievo
