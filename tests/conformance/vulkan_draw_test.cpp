#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/jobs.hpp"

namespace relievo {
namespace {

using namespace test;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr int width = 8, height = 4;

const std::string plain_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in float value;
layout(location = 0) out float shade;
void main() { gl_Position = vec4(position, 1.0); shade = value; }
)";

const std::string plain_fragment = R"(
layout(location = 0) in float shade;
layout(location = 0) out vec4 color;
void main() { color = vec4(shade); }
)";

struct Vertex {
  float x, y, z, value;
};

using Triangles = std::vector<Vertex>;

/// A triangle over the whole target at one depth, counter-clockwise as seen in the image: row 0 is y = −1, so going
/// down the left side and then to the right is counter-clockwise.
Triangles full_triangle(float depth, float value) {
  return {{-1, -1, depth, value}, {-1, 3, depth, value}, {3, -1, depth, value}};
}

Triangles operator+(Triangles a, const Triangles& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ShaderProgram plain_program() {
  return {"plain",
          {compile_glsl(ShaderStage::vertex, plain_vertex), compile_glsl(ShaderStage::fragment, plain_fragment)},
          {},
          {}};
}

/// Draws triangles to a float target (texture 0) with a depth target (texture 1), both cleared, and reads both.
Job draw_job(const Triangles& vertices) {
  Job job;
  job.name = "draw";
  job.programs = {plain_program()};
  job.buffers = {make_buffer("vertices", vertices)};
  job.textures = {make_texture("color", Format::r32_float, width, height),
                  make_texture("depth", Format::d32_float, width, height)};
  Draw draw;
  draw.vertex_stride = sizeof(Vertex);
  draw.attributes = {{0, Format::rgb32_float, 0}, {1, Format::r32_float, 12}};
  draw.count = static_cast<std::uint32_t>(vertices.size());
  draw.color_targets = {0};
  draw.depth_target = 1;
  draw.clear_color = {{0, 0, 0, 0}};
  draw.clear_depth = 1.0f;
  job.commands = {draw};
  job.read_backs = {{ReadBack::Source::texture, 0, 0}, {ReadBack::Source::texture, 1, 0}};
  return job;
}

Draw& draw_of(Job& job, std::size_t command = 0) {
  return std::get<Draw>(job.commands[command]);
}

std::vector<float> image(const Job& job) {
  return from_bytes<float>(run(job).read_backs[0]);
}

TEST(VulkanDraw, CoversTheTargetAndWritesDepth) {
  const JobResult result = run(draw_job(full_triangle(0.25f, 0.5f)));
  EXPECT_THAT(from_bytes<float>(result.read_backs[0]), Each(0.5f));
  EXPECT_THAT(from_bytes<float>(result.read_backs[1]), Each(0.25f));
}

TEST(VulkanDraw, RowZeroIsTheSmallestY) {
  // The quarter of the target with x < 0 and y < 0.
  const Triangles quad = {{-1, -1, 0, 1}, {-1, 0, 0, 1}, {0, -1, 0, 1}, {0, -1, 0, 1}, {-1, 0, 0, 1}, {0, 0, 0, 1}};
  EXPECT_THAT(image(draw_job(quad)), ElementsAre(1, 1, 1, 1, 0, 0, 0, 0,  //
                                                 1, 1, 1, 1, 0, 0, 0, 0,  //
                                                 0, 0, 0, 0, 0, 0, 0, 0,  //
                                                 0, 0, 0, 0, 0, 0, 0, 0));
}

TEST(VulkanDraw, NearerSurfacesWinWhateverTheOrder) {
  EXPECT_THAT(image(draw_job(full_triangle(0.2f, 1) + full_triangle(0.6f, 2))), Each(1.0f));
  EXPECT_THAT(image(draw_job(full_triangle(0.6f, 2) + full_triangle(0.2f, 1))), Each(1.0f));
}

TEST(VulkanDraw, EqualDepthPasses) {
  EXPECT_THAT(image(draw_job(full_triangle(0.5f, 1) + full_triangle(0.5f, 2))), Each(2.0f));
}

TEST(VulkanDraw, WithoutADepthTargetTheLastWins) {
  Job job = draw_job(full_triangle(0.2f, 1) + full_triangle(0.6f, 2));
  draw_of(job).depth_target = -1;
  EXPECT_THAT(image(job), Each(2.0f));
}

TEST(VulkanDraw, WithoutClearsItLoadsWhatIsThere) {
  const Triangles left = {{-1, -1, 0.1f, 3}, {-1, 1, 0.1f, 3}, {0, -1, 0.1f, 3},
                          {0, -1, 0.1f, 3},  {-1, 1, 0.1f, 3}, {0, 1, 0.1f, 3}};
  Job job = draw_job(full_triangle(0.5f, 1));
  job.buffers.push_back(make_buffer("left", left));
  Draw second = draw_of(job);
  second.vertex_buffer = 1;
  second.count = 6;
  second.clear_color.reset();
  second.clear_depth.reset();
  job.commands.emplace_back(second);
  const JobResult result = run(job);
  const auto color = from_bytes<float>(result.read_backs[0]);
  const auto depth = from_bytes<float>(result.read_backs[1]);
  for (std::size_t i = 0; i < color.size(); ++i) {
    const bool is_left = i % width < width / 2;
    EXPECT_EQ(color[i], is_left ? 3.0f : 1.0f) << i;
    EXPECT_EQ(depth[i], is_left ? 0.1f : 0.5f) << i;
  }
}

TEST(VulkanDraw, CullsBySideAsSeenInTheImage) {
  const Triangles front = full_triangle(0.5f, 1);
  const Triangles back = {front[0], front[2], front[1]};
  const auto drawn = [](const Triangles& triangles, CullMode cull) {
    Job job = draw_job(triangles);
    draw_of(job).cull = cull;
    return image(job)[0] == 1.0f;
  };
  EXPECT_TRUE(drawn(front, CullMode::none));
  EXPECT_TRUE(drawn(back, CullMode::none));
  EXPECT_TRUE(drawn(front, CullMode::back));
  EXPECT_FALSE(drawn(back, CullMode::back));
  EXPECT_FALSE(drawn(front, CullMode::front));
  EXPECT_TRUE(drawn(back, CullMode::front));
}

TEST(VulkanDraw, TellsFrontFacesToTheShader) {
  Job job = draw_job(full_triangle(0.5f, 1));
  job.programs[0].shaders[1] = compile_glsl(ShaderStage::fragment, R"(
layout(location = 0) in float shade;
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_FrontFacing ? shade : -shade); }
)");
  EXPECT_THAT(image(job), Each(1.0f));
}

TEST(VulkanDraw, FollowsIndices) {
  Triangles vertices = full_triangle(0.5f, 4);
  vertices.insert(vertices.begin(), {0, 0, 0, 9});
  Job job = draw_job(vertices);
  job.buffers.push_back(make_buffer("indices", std::vector<std::uint32_t>{1, 2, 3}));
  draw_of(job).index_buffer = 1;
  draw_of(job).count = 3;
  EXPECT_THAT(image(job), Each(4.0f));
}

TEST(VulkanDraw, PullsVerticesPerInstanceWithoutAVertexBuffer) {
  Job job = draw_job(full_triangle(0, 0));
  // Instance k covers column k with the value k.
  job.programs[0].shaders[0] = compile_glsl(ShaderStage::vertex, R"(
layout(std430, set = 0, binding = 0) readonly buffer Corners { vec2 corners[]; };
layout(location = 0) out float shade;
void main() {
  vec2 corner = corners[gl_VertexIndex];
  gl_Position = vec4((float(gl_InstanceIndex) + corner.x) / 4.0 - 1.0, 2.0 * corner.y - 1.0, 0.0, 1.0);
  shade = float(gl_InstanceIndex);
}
)");
  job.programs[0].bindings = {{ResourceKind::storage_buffer, 0, 0, "Corners", 0}};
  job.buffers = {make_buffer("corners", std::vector<float>{0, 0, 0, 1, 1, 0, 1, 0, 0, 1, 1, 1})};
  Draw& draw = draw_of(job);
  draw.attributes.clear();
  draw.resources = {{0, 0, 0}};
  draw.count = 6;
  draw.instances = width;
  const auto color = image(job);
  for (std::size_t i = 0; i < color.size(); ++i) EXPECT_EQ(color[i], static_cast<float>(i % width)) << i;
}

TEST(VulkanDraw, RunsAGeometryShader) {
  Job job = draw_job({{-1, -1, 0, 5}, {-1, -1, 0, 5}, {-1, -1, 0, 5}});  // no area: what is seen is emitted
  job.programs[0].shaders.insert(job.programs[0].shaders.begin() + 1, compile_glsl(ShaderStage::geometry, R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) in float shade[];
layout(location = 0) out float out_shade;
void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = vec4(i == 2 ? 3.0 : -1.0, i == 1 ? 3.0 : -1.0, 0.5, 1.0);
    out_shade = shade[i] + 1.0;
    EmitVertex();
  }
}
)"));
  EXPECT_THAT(image(job), Each(6.0f));
}

TEST(VulkanDraw, RunsTessellationShaders) {
  Job job = draw_job(full_triangle(0.5f, 1));
  auto& shaders = job.programs[0].shaders;
  shaders.insert(shaders.begin() + 1, compile_glsl(ShaderStage::tessellation_control, R"(
layout(vertices = 3) out;
layout(location = 0) in float shade[];
layout(location = 0) out float control_shade[];
void main() {
  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
  control_shade[gl_InvocationID] = shade[gl_InvocationID];
  gl_TessLevelOuter[gl_InvocationID] = 4.0;
  gl_TessLevelInner[0] = 4.0;
}
)"));
  shaders.insert(shaders.begin() + 2, compile_glsl(ShaderStage::tessellation_evaluation, R"(
layout(triangles, equal_spacing, ccw) in;
layout(location = 0) in float control_shade[];
layout(location = 0) out float out_shade;
void main() {
  gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position +
                gl_TessCoord.z * gl_in[2].gl_Position;
  out_shade = 2.0 * control_shade[0];
}
)"));
  EXPECT_THAT(image(job), Each(2.0f));
}

TEST(VulkanDraw, WritesSeveralTargetsOfDifferentFormats) {
  Job job = draw_job(full_triangle(0.5f, 1));
  job.programs[0].shaders[1] = compile_glsl(ShaderStage::fragment, R"(
layout(location = 0) in float shade;
layout(location = 0) out float value;
layout(location = 1) out vec4 color;
layout(location = 2) out uint id;
void main() { value = shade; color = vec4(0.0, 1.0, 0.2, 1.0); id = 77u; }
)");
  job.textures.push_back(make_texture("rgba", Format::rgba8_unorm, width, height));
  job.textures.push_back(make_texture("id", Format::r32_uint, width, height));
  draw_of(job).color_targets = {0, 2, 3};
  job.read_backs.push_back({ReadBack::Source::texture, 2, 0});
  job.read_backs.push_back({ReadBack::Source::texture, 3, 0});
  const JobResult result = run(job);
  EXPECT_THAT(from_bytes<float>(result.read_backs[0]), Each(1.0f));
  EXPECT_THAT(from_bytes<std::uint32_t>(result.read_backs[2]), Each(0xff33ff00u));
  EXPECT_THAT(from_bytes<std::uint32_t>(result.read_backs[3]), Each(77u));
}

TEST(VulkanDraw, ClearsAnIntegerTargetToTheWholeNumber) {
  Job job = draw_job({{5, 5, 0, 1}, {5, 5, 0, 1}, {5, 5, 0, 1}});
  job.programs[0].shaders[1] = compile_glsl(ShaderStage::fragment, R"(
layout(location = 0) in float shade;
layout(location = 0) out uint id;
void main() { id = uint(shade); }
)");
  job.textures[0].format = Format::r32_uint;
  draw_of(job).clear_color = {{12, 0, 0, 0}};
  EXPECT_THAT(from_bytes<std::uint32_t>(run(job).read_backs[0]), Each(12u));
}

TEST(VulkanDraw, DrawsDepthAlone) {
  Job job = draw_job(full_triangle(0.75f, 1));
  draw_of(job).color_targets.clear();
  job.programs[0].shaders[1] = compile_glsl(ShaderStage::fragment, R"(
layout(location = 0) in float shade;
void main() { gl_FragDepth = 0.5 * gl_FragCoord.z * shade; }
)");
  EXPECT_THAT(from_bytes<float>(run(job).read_backs[1]), Each(0.375f));
}

TEST(VulkanDraw, SamplesInVertexAndFragmentWhatAnEarlierDrawMade) {
  Job job = draw_job(full_triangle(0.5f, 0.25f));
  job.textures.push_back(make_texture("second", Format::r32_float, width, height));
  ShaderProgram reader = plain_program();
  reader.shaders = {compile_glsl(ShaderStage::vertex, R"(
layout(location = 0) in vec3 position;
layout(set = 1, binding = 0) uniform sampler2D map;
layout(location = 0) out float shade;
void main() { gl_Position = vec4(position, 1.0); shade = textureLod(map, vec2(0.5), 0.0).r; }
)"),
                    compile_glsl(ShaderStage::fragment, R"(
layout(location = 0) in float shade;
layout(location = 0) out vec4 color;
layout(set = 1, binding = 0) uniform sampler2D map;
void main() { color = vec4(shade + texelFetch(map, ivec2(gl_FragCoord.xy), 0).r); }
)")};
  reader.bindings = {{ResourceKind::sampled_texture, 1, 0, "map", 0}};
  job.programs.push_back(reader);
  Draw second = draw_of(job);
  second.program = 1;
  second.resources = {{1, 0, 0}};
  second.color_targets = {2};
  second.attributes.pop_back();
  job.commands.emplace_back(second);
  job.read_backs.push_back({ReadBack::Source::texture, 2, 0});
  EXPECT_THAT(from_bytes<float>(run(job).read_backs[2]), Each(0.5f));
}

TEST(VulkanDraw, StoresFromFragments) {
  Job job = draw_job(full_triangle(0.5f, 1));
  job.programs[0].shaders[1] = compile_glsl(ShaderStage::fragment, R"(
layout(location = 0) in float shade;
layout(location = 0) out vec4 color;
layout(std430, set = 0, binding = 0) buffer Count { uint count; };
void main() { color = vec4(shade); atomicAdd(count, 1u); }
)");
  job.programs[0].bindings = {{ResourceKind::storage_buffer, 0, 0, "Count", 0}};
  job.buffers.push_back(make_buffer("count", 4));
  draw_of(job).resources = {{0, 0, 1}};
  job.read_backs.push_back({ReadBack::Source::buffer, 1, 0});
  EXPECT_THAT(from_bytes<std::uint32_t>(run(job).read_backs[2]), ElementsAre(width * height));
}

TEST(VulkanDraw, TwoRunsAndASerialisedOneAreByteIdentical) {
  const Triangles slanted = {{-0.9f, -0.7f, 0.1f, 0.1f}, {-0.3f, 0.95f, 0.9f, 0.7f}, {0.8f, -0.2f, 0.4f, 0.3f}};
  const Job job = draw_job(slanted);
  const Result<Job> parsed = parse_job(serialize_job(job));
  ASSERT_TRUE(parsed);
  const auto first = run(job).read_backs;
  EXPECT_EQ(run(job).read_backs, first);
  EXPECT_EQ(run(*parsed).read_backs, first);
  EXPECT_NE(first[0], Bytes(first[0].size()));
}

TEST(VulkanDraw, IndicesBeyondTheVerticesReadZeroAtMost) {
  Job job = draw_job(full_triangle(0.5f, 1));
  job.programs.push_back(make_compute("indices", R"(
layout(local_size_x = 3) in;
layout(std430, set = 0, binding = 0) buffer Result { uint indices[]; };
void main() { indices[gl_GlobalInvocationID.x] = 1000000u; }
)"));
  job.buffers.push_back(make_buffer("indices", 12));
  job.commands.insert(job.commands.begin(), Dispatch{1, {{0, 0, 1}}, {1, 1, 1}});
  draw_of(job, 1).index_buffer = 1;
  EXPECT_THAT(image(job), Each(0.0f));
}

/// The fragment shader reads an input that the vertex shader does not write.
Job mismatched_job() {
  Job job = draw_job(full_triangle(0.5f, 1));
  job.programs[0].shaders[1] = compile_glsl(ShaderStage::fragment, R"(
layout(location = 3) in float missing;
layout(location = 0) out vec4 color;
void main() { color = vec4(missing); }
)");
  return job;
}

TEST(VulkanValidation, ReportsASeededError) {
  const auto result = vulkan().execute(mismatched_job());
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_THAT(result->messages, testing::Contains(HasSubstr("InputNotProduced")));
}

TEST(VulkanValidation, KeepsMessagesOfOneJobFromTheNext) {
  ASSERT_TRUE(vulkan().execute(mismatched_job()));
  EXPECT_THAT(image(draw_job(full_triangle(0.5f, 0.5f))), Each(0.5f));
}

TEST(VulkanValidation, IsSilentWhenNotAskedFor) {
  const auto backend = open_backend("vulkan");
  ASSERT_TRUE(backend);
  const auto result = (*backend)->execute(mismatched_job());
  ASSERT_TRUE(result);
  EXPECT_THAT(result->messages, testing::IsEmpty());
}

}  // namespace
}  // namespace relievo
