// Draws through the OpenGL backend: conventions of clip space and winding, targets, depth, all stages.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "backends/opengl/vertex_order.hpp"
#include "opengl_jobs.hpp"

namespace relievo {
namespace {

using namespace opengl_jobs;
using testing::Each;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::SizeIs;

struct Vertex {
  float x, y, z, value;
};

const std::string pass_through =
    "layout(location = 0) in vec3 position; layout(location = 1) in float value_in;\n"
    "layout(location = 0) out float value;\n"
    "void main() { gl_Position = vec4(position, 1.0); value = value_in; }";

/// A triangle over the whole image. With row 0 at the top its corners go top left, bottom left, top right:
/// counter-clockwise.
std::vector<Vertex> covering(float z = 0.5f, float value = 1.0f) {
  return {{-1, -1, z, value}, {-1, 3, z, value}, {3, -1, z, value}};
}

std::vector<Vertex> reversed(std::vector<Vertex> vertices) {
  std::reverse(vertices.begin(), vertices.end());
  return vertices;
}

Texture make_target(const std::string& name, Format format, int width, int height) {
  Texture target;
  target.name = name;
  target.format = format;
  target.width = width;
  target.height = height;
  return target;
}

/// One draw to a cleared r32_float target of width x height, which is read back; `fragment` writes `color`.
Job draw_job(const std::vector<Vertex>& vertices, const std::string& fragment, int width = 4, int height = 3) {
  Job job;
  job.name = "draw";
  const std::string head = "layout(location = 0) in float value;\nlayout(location = 0) out float color;\n";
  job.programs = {
      {"draw",
       {make_shader(ShaderStage::vertex, pass_through), make_shader(ShaderStage::fragment, head + fragment)},
       {},
       {}}};
  job.buffers = {make_buffer("vertices", vertices)};
  job.textures = {make_target("color", Format::r32_float, width, height)};
  Draw draw;
  draw.vertex_stride = sizeof(Vertex);
  draw.attributes = {{0, Format::rgb32_float, 0}, {1, Format::r32_float, 12}};
  draw.count = static_cast<std::uint32_t>(vertices.size());
  draw.color_targets = {0};
  draw.clear_color = {-1, 0, 0, 0};
  job.commands = {draw};
  job.read_backs = {{ReadBack::Source::texture, 0, 0}};
  return job;
}

Draw& first_draw(Job& job) {
  return std::get<Draw>(job.commands[0]);
}

std::vector<float> image(const JobResult& result, std::size_t read_back = 0) {
  return result.read_backs.size() > read_back ? from_bytes<float>(result.read_backs[read_back]) : std::vector<float>{};
}

TEST(OpenGlDraw, RowZeroIsClipSpaceYMinusOne) {
  // The value is NDC y: −1 at the first vertex, and growing along the second.
  const std::vector<Vertex> vertices = {{-1, -1, 0, -1}, {-1, 3, 0, 3}, {3, -1, 0, -1}};
  const auto rows = image(run(draw_job(vertices, "void main() { color = value; }", 2, 4)));
  EXPECT_THAT(rows, ElementsAre(-0.75, -0.75, -0.25, -0.25, 0.25, 0.25, 0.75, 0.75));
}

TEST(OpenGlDraw, FragCoordCountsTexelCentresFromRowZero) {
  const auto texels =
      image(run(draw_job(covering(0.25f), "void main() { color = gl_FragCoord.x + 10.0 * gl_FragCoord.y; }", 3, 2)));
  EXPECT_THAT(texels, ElementsAre(5.5, 6.5, 7.5, 15.5, 16.5, 17.5));
}

TEST(OpenGlDraw, DerivativesGrowWithTheRow) {
  const auto texels = image(run(draw_job(covering(), "void main() { color = dFdy(gl_FragCoord.y * 3.0); }", 4, 4)));
  EXPECT_THAT(texels, Each(3.0f));
}

TEST(OpenGlDraw, DepthRunsFromZeroToOneAndClipsOutside) {
  const std::string depth = "void main() { color = gl_FragCoord.z; }";
  EXPECT_THAT(image(run(draw_job(covering(0.25f), depth))), Each(0.25f));
  EXPECT_THAT(image(run(draw_job(covering(0.0f), depth))), Each(0.0f));
  EXPECT_THAT(image(run(draw_job(covering(-0.01f), depth))), Each(-1.0f));
  EXPECT_THAT(image(run(draw_job(covering(1.01f), depth))), Each(-1.0f));
}

TEST(OpenGlDraw, CounterClockwiseInTheImageIsFront) {
  const std::string facing = "void main() { color = gl_FrontFacing ? 1.0 : 0.0; }";
  EXPECT_THAT(image(run(draw_job(covering(), facing))), Each(1.0f));
  EXPECT_THAT(image(run(draw_job(reversed(covering()), facing))), Each(0.0f));
}

TEST(OpenGlDraw, CullsTheFaceThatItIsTold) {
  struct Case {
    CullMode cull;
    bool front_drawn, back_drawn;
  };
  for (const Case& c :
       {Case{CullMode::none, true, true}, Case{CullMode::back, true, false}, Case{CullMode::front, false, true}}) {
    Job front = draw_job(covering(), "void main() { color = value; }");
    Job back = draw_job(reversed(covering()), "void main() { color = value; }");
    first_draw(front).cull = first_draw(back).cull = c.cull;
    EXPECT_THAT(image(run(front)), Each(c.front_drawn ? 1.0f : -1.0f));
    EXPECT_THAT(image(run(back)), Each(c.back_drawn ? 1.0f : -1.0f));
  }
}

TEST(OpenGlDraw, FlatInputsComeFromTheFirstVertex) {
  std::vector<Vertex> vertices = covering();
  for (std::size_t i = 0; i < 3; ++i) vertices[i].value = static_cast<float>(i + 5);
  Job job = draw_job(vertices, "");
  job.programs[0].shaders = {
      make_shader(ShaderStage::vertex,
                  "layout(location = 0) in vec3 position; layout(location = 1) in float value_in;\n"
                  "layout(location = 0) flat out float value;\n"
                  "void main() { gl_Position = vec4(position, 1.0); value = value_in; }"),
      make_shader(ShaderStage::fragment,
                  "layout(location = 0) flat in float value; layout(location = 0) out float color;\n"
                  "void main() { color = value; }")};
  EXPECT_THAT(image(run(job)), Each(5.0f));
}

Job depth_job(const std::vector<Vertex>& vertices) {
  Job job = draw_job(vertices, "void main() { color = value; }");
  job.textures.push_back(make_target("depth", Format::d32_float, 4, 3));
  first_draw(job).depth_target = 1;
  first_draw(job).clear_depth = 0.75f;
  job.read_backs.push_back({ReadBack::Source::texture, 1, 0});
  return job;
}

std::vector<Vertex> joined(std::vector<Vertex> first, const std::vector<Vertex>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

TEST(OpenGlDraw, TheNearerTriangleWins) {
  for (const auto& vertices :
       {joined(covering(0.5f, 1), covering(0.25f, 2)), joined(covering(0.25f, 2), covering(0.5f, 1))}) {
    const JobResult result = run(depth_job(vertices));
    EXPECT_THAT(image(result, 0), Each(2.0f));
    EXPECT_THAT(image(result, 1), Each(0.25f));
  }
}

TEST(OpenGlDraw, AtEqualDepthTheLaterTriangleWins) {
  EXPECT_THAT(image(run(depth_job(joined(covering(0.5f, 1), covering(0.5f, 2))))), Each(2.0f));
}

TEST(OpenGlDraw, BehindTheClearedDepthNothingIsDrawn) {
  const JobResult result = run(depth_job(covering(0.8f)));
  EXPECT_THAT(image(result, 0), Each(-1.0f));
  EXPECT_THAT(image(result, 1), Each(0.75f));
}

TEST(OpenGlDraw, DepthAloneIsATarget) {
  Job job = depth_job(covering(0.25f));
  first_draw(job).color_targets.clear();
  job.programs[0].shaders[1] = make_shader(ShaderStage::fragment, "void main() { gl_FragDepth = 0.125; }");
  EXPECT_THAT(image(run(job), 1), Each(0.125f));
}

TEST(OpenGlDraw, LaterDrawsKeepWhatIsNotCleared) {
  Job job = depth_job(covering(0.25f));
  Draw second = first_draw(job);
  second.clear_color.reset();
  second.clear_depth.reset();
  second.vertex_buffer = 1;
  job.buffers.push_back(make_buffer("farther", covering(0.5f, 9)));
  job.commands.push_back(second);
  EXPECT_THAT(image(run(job)), Each(1.0f));
  std::get<Draw>(job.commands[1]).clear_depth = 1.0f;
  EXPECT_THAT(image(run(job)), Each(9.0f));
}

TEST(OpenGlDraw, SeveralTargetsOfSeveralFormats) {
  Job job = draw_job(covering(), "");
  job.programs[0].shaders[1] = make_shader(
      ShaderStage::fragment,
      "layout(location = 0) out float a; layout(location = 1) out vec4 b; layout(location = 2) out uint c;\n"
      "layout(location = 3) out vec2 d;\n"
      "void main() { if (gl_FragCoord.x > 1.0) discard;\n"
      "  a = 0.5; b = vec4(0.0, 0.2, 0.4, 1.0); c = 4000000000u; d = vec2(0.0, 1.0); }");
  job.textures = {make_target("a", Format::r32_float, 2, 1), make_target("b", Format::rgba8_unorm, 2, 1),
                  make_target("c", Format::r32_uint, 2, 1), make_target("d", Format::rg16_unorm, 2, 1)};
  first_draw(job).color_targets = {0, 1, 2, 3};
  first_draw(job).clear_color = {1, 1, 0, 0};
  for (int i = 1; i < 4; ++i) job.read_backs.push_back({ReadBack::Source::texture, i, 0});
  const JobResult result = run(job);
  ASSERT_THAT(result.read_backs, SizeIs(4));
  EXPECT_THAT(image(result, 0), ElementsAre(0.5, 1));
  EXPECT_THAT(from_bytes<std::uint8_t>(result.read_backs[1]), ElementsAre(0, 51, 102, 255, 255, 255, 0, 0));
  EXPECT_THAT(from_bytes<std::uint32_t>(result.read_backs[2]), ElementsAre(4000000000u, 1));
  EXPECT_THAT(from_bytes<std::uint16_t>(result.read_backs[3]), ElementsAre(0, 65535, 65535, 65535));
}

TEST(OpenGlDraw, ColorsAreStoredWithoutDitherOrSrgb) {
  Job job = draw_job(covering(), "", 64, 4);
  job.programs[0].shaders[1] =
      make_shader(ShaderStage::fragment, "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(0.2502); }");
  job.textures[0].format = Format::rgba8_unorm;
  const JobResult result = run(job);
  EXPECT_THAT(from_bytes<std::uint8_t>(result.read_backs.at(0)), Each(64));
}

TEST(OpenGlDraw, DrawsIndicesAndInstances) {
  Job job = draw_job(joined(covering(0.5f, 7), covering(0.5f, 8)), "void main() { color = value; }");
  job.buffers.push_back(make_buffer<std::uint32_t>("indices", {3, 4, 5}));
  first_draw(job).index_buffer = 1;
  first_draw(job).count = 3;
  first_draw(job).instances = 2;
  job.programs[0].shaders[0] = make_shader(
      ShaderStage::vertex,
      "layout(location = 0) in vec3 position; layout(location = 1) in float value_in;\n"
      "layout(location = 0) out float value;\n"
      "void main() { gl_Position = vec4(position, 1.0); value = value_in + 100.0 * float(gl_InstanceID); }");
  EXPECT_THAT(image(run(job)), Each(108.0f));
}

TEST(OpenGlDraw, VerticesArePulledFromABufferAndATexture) {
  Job job = draw_job(covering(), "void main() { color = value; }");
  job.programs[0].shaders[0] = make_shader(
      ShaderStage::vertex,
      "layout(std430) readonly buffer Corners { vec2 corner[]; };\nuniform sampler2D map;\n"
      "layout(location = 0) out float value;\n"
      "void main() { gl_Position = vec4(corner[gl_VertexID], 0.5, 1.0); value = textureLod(map, vec2(0.5), 0.0).r; }");
  job.programs[0].bindings = {storage_slot(4, "Corners"), texture_slot(5, "map")};
  job.buffers.push_back(make_buffer<float>("corners", {-1, -1, -1, 3, 3, -1}));
  job.textures.push_back(make_target("map", Format::r32_float, 1, 1));
  job.textures[1].data = {to_bytes(std::vector<float>{6.0f})};
  first_draw(job).attributes.clear();
  first_draw(job).resources = {{0, 4, 1}, {0, 5, 1}};
  EXPECT_THAT(image(run(job)), Each(6.0f));
}

TEST(OpenGlDraw, AGeometryShaderMakesTriangles) {
  // It replaces the triangle by one over the left half and one over the right half, with other values.
  Job job = draw_job(covering(), "void main() { color = value; }", 4, 2);
  job.programs[0].shaders.push_back(
      make_shader(ShaderStage::geometry,
                  "layout(triangles) in; layout(triangle_strip, max_vertices = 8) out;\n"
                  "layout(location = 0) in float value[]; layout(location = 0) out float result;\n"
                  "void half_image(float left, float v) {\n"
                  "  for (int i = 0; i < 4; ++i) { result = v;\n"
                  "    gl_Position = vec4(left + float(i & 1), -1.0 + 2.0 * float(i >> 1), 0.5, 1.0); EmitVertex(); }\n"
                  "  EndPrimitive(); }\n"
                  "void main() { half_image(-1.0, 3.0 * value[0]); half_image(0.0, 4.0 * value[2]); }"));
  job.programs[0].shaders[1] = make_shader(
      ShaderStage::fragment,
      "layout(location = 0) in float result; layout(location = 0) out float color; void main() { color = result; }");
  EXPECT_THAT(image(run(job)), ElementsAre(3, 3, 4, 4, 3, 3, 4, 4));
}

Job tessellated_job(const std::string& order, const std::vector<Vertex>& vertices) {
  Job job = draw_job(vertices, "void main() { color = value * (gl_FrontFacing ? 1.0 : 2.0); }", 8, 8);
  auto& shaders = job.programs[0].shaders;
  shaders.push_back(make_shader(
      ShaderStage::tessellation_control,
      "layout(vertices = 3) out; layout(location = 0) in float value[]; layout(location = 0) out float mid[];\n"
      "void main() { gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
      "  mid[gl_InvocationID] = value[gl_InvocationID]; gl_TessLevelInner[0] = 3.0;\n"
      "  gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 3.0; }"));
  shaders.push_back(make_shader(
      ShaderStage::tessellation_evaluation,
      "layout(triangles, " + order +
          ", equal_spacing) in;\n"
          "layout(location = 0) in float mid[]; layout(location = 0) out float value;\n"
          "void main() { value = mid[0] + 0.0 * gl_TessCoord.x;\n"
          "  gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position +\n"
          "                gl_TessCoord.z * gl_in[2].gl_Position; }"));
  return job;
}

TEST(OpenGlDraw, TessellatedTrianglesWindAsInVulkan) {
  // The domain's origin is at the upper left, so `cw` keeps the winding of the patch and `ccw` turns it.
  EXPECT_THAT(image(run(tessellated_job("cw", covering()))), Each(1.0f));
  EXPECT_THAT(image(run(tessellated_job("ccw", covering()))), Each(2.0f));
  EXPECT_THAT(image(run(tessellated_job("ccw", reversed(covering())))), Each(1.0f));
}

TEST(OpenGlVertexOrder, IsExchangedInInputLayoutsAlone) {
  EXPECT_EQ(opengl::exchange_vertex_order("layout(triangles, ccw, equal_spacing) in;\nfloat ccw;"),
            "layout(triangles, cw, equal_spacing) in;\nfloat ccw;");
  EXPECT_EQ(opengl::exchange_vertex_order("layout(cw) in; layout(location = 0) in vec3 accw;"),
            "layout(ccw) in; layout(location = 0) in vec3 accw;");
}

}  // namespace
}  // namespace relievo
