// The OpenGL backend on the driver of this machine: what it reports, compute, constants, errors and clean-up.

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <thread>

#include "backends/opengl/context.hpp"
#include "backends/opengl/execution.hpp"
#include "backends/opengl/libraries.hpp"
#include "backends/opengl/resources.hpp"
#include "backends/opengl/specialization.hpp"
#include "opengl_jobs.hpp"

namespace relievo {
namespace {

using namespace opengl_jobs;
using testing::AllOf;
using testing::Contains;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::SizeIs;

Job square_job(int count) {
  Job job = compute_job(
      "layout(local_size_x = 1) in;\n"
      "layout(std430) readonly buffer In { float v[]; } source;\n"
      "layout(std430) buffer Out { float v[]; } target;\n"
      "layout(std140) uniform Scale { float scale; };\n"
      "void main() { uint i = gl_GlobalInvocationID.x; target.v[i] = scale * source.v[i] * source.v[i]; }\n",
      4 * static_cast<std::size_t>(count));
  std::vector<float> values;
  for (int i = 0; i < count; ++i) values.push_back(0.25f * static_cast<float>(i));
  // Slots out of order, and none in the text: the names alone connect them.
  job.programs[0].bindings = {{ResourceKind::storage_buffer, 0, 0, "Out", 3},
                              {ResourceKind::storage_buffer, 1, 0, "In", 1},
                              {ResourceKind::uniform_buffer, 1, 2, "Scale", 2}};
  job.buffers.push_back(make_buffer("in", values));
  job.buffers.push_back(make_buffer<float>("scale", {3.0f}));
  job.commands = {Dispatch{0, {{0, 0, 0}, {1, 0, 1}, {1, 2, 2}}, {static_cast<std::uint32_t>(count), 1, 1}}};
  return job;
}

/// A draw whose geometry shader wants lines: no check of ours can see it, OpenGL reports GL_INVALID_OPERATION.
Job wrong_primitive_job() {
  Job job;
  job.name = "wrong";
  const ShaderCode vertex = make_shader(ShaderStage::vertex, "void main() { gl_Position = vec4(0); }");
  const ShaderCode geometry =
      make_shader(ShaderStage::geometry,
                  "layout(lines) in; layout(triangle_strip, max_vertices = 3) out;\n"
                  "void main() { gl_Position = gl_in[0].gl_Position; EmitVertex(); EndPrimitive(); }");
  const ShaderCode fragment =
      make_shader(ShaderStage::fragment, "layout(location = 0) out vec4 color; void main() { color = vec4(1); }");
  job.programs = {{"lines", {vertex, geometry, fragment}, {}, {}}};
  job.textures.resize(1);
  Draw draw;
  draw.count = 3;
  draw.color_targets = {0};
  job.commands = {draw};
  return job;
}

Error error_of(const Job& job, bool validation = false) {
  const auto backend = open_opengl(validation);
  auto result = backend->execute(job);
  EXPECT_FALSE(result) << "expected an error";
  return result ? Error{} : result.error();
}

TEST(OpenGlBackend, ReportsDeviceAndFeatures) {
  const auto infos = list_backends();
  const auto info = std::find_if(infos.begin(), infos.end(), [](const auto& i) { return i.name == "opengl"; });
  ASSERT_NE(info, infos.end());
  EXPECT_TRUE(info->available) << info->reason;
  EXPECT_THAT(info->reason, IsEmpty());
  EXPECT_EQ(info->shader_target, "glsl-450");
  EXPECT_NE(info->device, "");
  EXPECT_THAT(info->api_version, ContainsRegex("^4\\.[56]"));
  EXPECT_THAT(info->features, IsSupersetOf({"compute", "geometry", "tessellation", "timestamps", "validation"}));
  EXPECT_EQ(info->features.contains("software"), info->device.find("llvmpipe") != std::string::npos);
}

TEST(OpenGlBackend, SelectsTheDeviceByPartOfItsName) {
  BackendOptions options;
  options.device = open_opengl()->info().device.substr(1, 4);
  EXPECT_TRUE(open_backend("opengl", options));
  options.device = "no such device";
  const auto backend = open_backend("opengl", options);
  ASSERT_FALSE(backend);
  EXPECT_EQ(backend.error().id, "backend.unknown-device");
  EXPECT_EQ(backend.error().code, ErrorCode::unsupported);
  EXPECT_THAT(backend.error().message, HasSubstr("'no such device'"));
}

TEST(OpenGlBackend, ComputeReadsAndWritesBuffersByName) {
  const JobResult result = run(square_job(1000));
  ASSERT_THAT(result.read_backs, SizeIs(1));
  const auto values = from_bytes<float>(result.read_backs.at(0));
  ASSERT_THAT(values, SizeIs(1000));
  for (int i = 0; i < 1000; ++i) {
    const float x = 0.25f * static_cast<float>(i);
    ASSERT_EQ(values[static_cast<std::size_t>(i)], 3.0f * x * x) << i;
  }
}

TEST(OpenGlBackend, BuffersWithoutDataAreZeroAndHaveTheirExactLength) {
  const JobResult result =
      run(compute_job("layout(local_size_x = 1) in; layout(std430, binding = 0) buffer Out { uint v[]; };\n"
                      "void main() { v[1] = v.length() + v[0] + v[2]; }",
                      12));
  EXPECT_THAT(from_bytes<std::uint32_t>(result.read_backs.at(0)), ElementsAre(0, 3, 0));
}

TEST(OpenGlBackend, EachCommandSeesWhatEarlierOnesWrote) {
  Job job = compute_job(
      "layout(local_size_x = 1) in; layout(std430, binding = 0) buffer Out { uint v[]; };\n"
      "void main() { v[0] = 3u * v[0] + 1u; }",
      4);
  job.commands.resize(5, job.commands[0]);
  const JobResult result = run(job);
  EXPECT_THAT(from_bytes<std::uint32_t>(result.read_backs.at(0)), ElementsAre(121));
  EXPECT_THAT(result.command_seconds, SizeIs(5));
}

TEST(OpenGlBackend, CommandSecondsGrowWithTheWork) {
  Job job = compute_job(
      "layout(local_size_x = 64) in; layout(std430, binding = 0) buffer Out { float v[]; };\n"
      "layout(std430, binding = 1) readonly buffer Count { uint count; };\n"
      "void main() { uint i = gl_GlobalInvocationID.x; float x = float(i);\n"
      "  for (uint k = 0u; k < count; ++k) x = sin(x); v[i] = x; }",
      4 * 6400);
  job.programs[0].bindings.push_back(storage_slot(1, "Count"));
  job.buffers.push_back(make_buffer<std::uint32_t>("few", {10}));
  job.buffers.push_back(make_buffer<std::uint32_t>("many", {2000}));
  // The first command warms up: drivers compile late.
  job.commands = {Dispatch{0, {{0, 0, 0}, {0, 1, 1}}, {100, 1, 1}}, Dispatch{0, {{0, 0, 0}, {0, 1, 1}}, {100, 1, 1}},
                  Dispatch{0, {{0, 0, 0}, {0, 1, 2}}, {100, 1, 1}}};
  const JobResult result = run(job);
  ASSERT_THAT(result.command_seconds, SizeIs(3));
  EXPECT_GT(result.command_seconds[1], 0.0);
  EXPECT_GT(result.command_seconds[2], 5 * result.command_seconds[1]);
}

Job constants_job(std::vector<SpecializationValue> constants) {
  Job job = compute_job(
      "#ifndef SPIRV_CROSS_CONSTANT_ID_1\n#define SPIRV_CROSS_CONSTANT_ID_1 7\n#endif\n"
      "const int COUNT = SPIRV_CROSS_CONSTANT_ID_1;\n"
      "#ifndef SPIRV_CROSS_CONSTANT_ID_11\n#define SPIRV_CROSS_CONSTANT_ID_11 0.5\n#endif\n"
      "const float SCALE = SPIRV_CROSS_CONSTANT_ID_11;\n"
      "#ifndef SPIRV_CROSS_CONSTANT_ID_2\n#define SPIRV_CROSS_CONSTANT_ID_2 true\n#endif\n"
      "const bool FLAG = SPIRV_CROSS_CONSTANT_ID_2;\n"
      "#ifndef SPIRV_CROSS_CONSTANT_ID_3\n#define SPIRV_CROSS_CONSTANT_ID_3 2u\n#endif\n"
      "layout(local_size_x = SPIRV_CROSS_CONSTANT_ID_3) in;\n"
      "layout(std430, binding = 0) buffer Out { uint v[]; };\n"
      "void main() { v[0] = uint(COUNT); v[1] = floatBitsToUint(SCALE); v[2] = uint(FLAG);\n"
      "  v[3] = gl_WorkGroupSize.x; }",
      16);
  job.programs[0].constants = std::move(constants);
  return job;
}

TEST(OpenGlBackend, SpecializationConstantsKeepTheirDefaults) {
  const JobResult result = run(constants_job({}));
  EXPECT_THAT(from_bytes<std::uint32_t>(result.read_backs.at(0)),
              ElementsAre(7, std::bit_cast<std::uint32_t>(0.5f), 1, 2));
}

TEST(OpenGlBackend, SpecializationConstantsTakeTheProgramsBits) {
  // Constant 99 is one that the optimiser removed from the text.
  for (const float value : {0.1f, -3.0f, 1e-30f, 16777217.0f, 3.40282347e38f}) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const JobResult result = run(constants_job({{1, 0x80000000u}, {11, bits}, {2, 0}, {3, 5}, {99, 4}}));
    EXPECT_THAT(from_bytes<std::uint32_t>(result.read_backs.at(0)), ElementsAre(0x80000000u, bits, 0, 5)) << value;
  }
}

TEST(OpenGlBackend, KeptProgramsAreNotTakenForOneAnother) {
  const auto backend = open_opengl();
  for (std::uint32_t round = 0; round < 2; ++round) {
    for (std::uint32_t i = 0; i < RecentPrograms<opengl::Program>::capacity + 3; ++i) {
      const Job job = constants_job({{1, i}});
      EXPECT_EQ(run(*backend, job).read_backs, run(job).read_backs) << "constant " << i;
    }
  }
}

TEST(OpenGlSpecialization, DefinesFollowTheExtensionsAndKeepLineNumbers) {
  const std::string text =
      "#version 450\n\n#extension GL_ARB_shader_group_vote : require\nconst float S = SPIRV_CROSS_CONSTANT_ID_4;\n";
  EXPECT_EQ(opengl::specialize(text, {{4, std::bit_cast<std::uint32_t>(2.0f)}}),
            "#version 450\n\n#extension GL_ARB_shader_group_vote : require\n"
            "#define SPIRV_CROSS_CONSTANT_ID_4 (2.0)\n#line 4\nconst float S = SPIRV_CROSS_CONSTANT_ID_4;\n");
  EXPECT_EQ(opengl::specialize(text, {{40, 1}}), text);
}

TEST(OpenGlSpecialization, NonFiniteFloatsAreMadeFromTheirBits) {
  const auto bits = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
  EXPECT_THAT(opengl::specialize("const float S = SPIRV_CROSS_CONSTANT_ID_0;", {{0, bits}}),
              HasSubstr("uintBitsToFloat(0x7f800000u)"));
}

TEST(OpenGlBackend, TwoRunsAreByteIdentical) {
  const Job job = square_job(257);
  const auto backend = open_opengl();
  const JobResult first = run(*backend, job), second = run(*backend, job), third = run(job);
  EXPECT_EQ(first.read_backs, second.read_backs);
  EXPECT_EQ(first.read_backs, third.read_backs);
}

TEST(OpenGlBackend, AJobThatIsNotNeededAgainRunsTheSame) {
  const Job job = square_job(257);
  std::vector<std::vector<std::byte>> taken;
  const Result<JobResult> once = open_opengl()->execute_once(
      job, [&](std::size_t, std::span<const std::byte> bytes) { taken.emplace_back(bytes.begin(), bytes.end()); });
  ASSERT_TRUE(once) << format(once.error());
  EXPECT_THAT(once->read_backs, testing::IsEmpty());
  EXPECT_EQ(taken, run(job).read_backs);
}

TEST(OpenGlBackend, BackendsAreUsedFromSeveralThreads) {
  const auto first = open_opengl(), second = open_opengl();
  std::vector<JobResult> results(4);
  std::thread([&] { results[0] = run(*first, square_job(9)); }).join();
  std::thread([&] { results[1] = run(*second, square_job(9)); }).join();
  results[2] = run(*first, square_job(9));
  std::thread one([&] { results[3] = run(*first, square_job(9)); });
  const JobResult beside = run(*second, square_job(9));
  one.join();
  for (const JobResult& result : results) EXPECT_EQ(result.read_backs, beside.read_backs);
}

using GetCurrentContext = EGLContext (*)();

TEST(OpenGlBackend, GivesTheThreadBackToTheApplicationsContext) {
  const auto backend = open_opengl();
  const auto current =
      reinterpret_cast<GetCurrentContext>(dlsym(dlopen("libEGL.so.1", RTLD_LAZY), "eglGetCurrentContext"));
  EXPECT_EQ(current(), EGL_NO_CONTEXT);
  run(*backend, square_job(3));
  EXPECT_EQ(current(), EGL_NO_CONTEXT);
  const auto application = opengl::Context::open({});
  ASSERT_TRUE(application);
  const opengl::CurrentContext scope(**application);
  const EGLContext own = current();
  EXPECT_NE(own, EGL_NO_CONTEXT);
  run(*backend, square_job(3));
  EXPECT_EQ(current(), own);
}

TEST(OpenGlBackend, OneBackendOutlivesAnother) {
  auto first = open_opengl();
  const auto second = open_opengl();
  first.reset();
  EXPECT_THAT(run(*second, square_job(3)).read_backs, SizeIs(1));
}

TEST(OpenGlBackend, DebugOutputReportsASeededError) {
  const auto backend = open_opengl();
  const auto result = backend->execute(wrong_primitive_job());
  ASSERT_TRUE(result) << format(result.error());
  EXPECT_THAT(result->messages, Contains(AllOf(HasSubstr("OpenGL error"), HasSubstr("GL_INVALID_OPERATION"))));
  EXPECT_THAT(run(*backend, square_job(3)).messages, IsEmpty());
}

TEST(OpenGlBackend, WithoutDebugOutputASeededErrorFailsTheJob) {
  const Error error = error_of(wrong_primitive_job());
  EXPECT_EQ(error.id, "backend.gl-error");
  EXPECT_EQ(error.code, ErrorCode::backend);
  EXPECT_THAT(error.message, AllOf(HasSubstr("job 'wrong', command 0"), HasSubstr("GL_INVALID_OPERATION")));
}

TEST(OpenGlBackend, BrokenGlslGivesTheDriversLog) {
  const Error error = error_of(compute_job("layout(local_size_x = 1) in;\nvoid main() { undeclared = 1; }", 4));
  EXPECT_EQ(error.id, "backend.glsl-compile");
  EXPECT_EQ(error.code, ErrorCode::compile);
  EXPECT_THAT(error.message, AllOf(HasSubstr("compute shader of program 'body'"), HasSubstr("undeclared")));
}

TEST(OpenGlBackend, TheLogKeepsLineNumbersUnderSpecialization) {
  Job job = compute_job("const int A = SPIRV_CROSS_CONSTANT_ID_0;\nvoid main() { undeclared = 1; }", 4);
  job.programs[0].constants = {{0, 5}};
  EXPECT_THAT(error_of(job).message, ContainsRegex("[:(]3[:()]"));
}

TEST(OpenGlBackend, ALinkErrorNamesTheProgram) {
  Job job = wrong_primitive_job();
  job.programs[0].shaders[2] =
      make_shader(ShaderStage::fragment, "in vec4 unwritten; out vec4 color; void main() { color = unwritten; }");
  const Error error = error_of(job);
  EXPECT_EQ(error.id, "backend.glsl-compile");
  EXPECT_THAT(error.message, AllOf(HasSubstr("does not link program 'lines'"), HasSubstr("unwritten")));
}

TEST(OpenGlBackend, AShaderWithoutItsTextIsAnError) {
  Job job = square_job(3);
  job.programs[0].shaders[0].text = {{"glsl-330", "#version 330\n"}};
  const Error error = error_of(job);
  EXPECT_EQ(error.id, "job.no-shader-text");
  EXPECT_THAT(error.message, HasSubstr("program 'body'"));
}

TEST(OpenGlBackend, AnInvalidJobIsRejected) {
  Job job = square_job(3);
  job.read_backs[0].index = 7;
  EXPECT_THAT(error_of(job).id, testing::StartsWith("job."));
}

TEST(OpenGlBackend, AResourceOutsideOfTheContractIsAnError) {
  Job job = square_job(3);
  job.programs[0].bindings[2].gl_slot = 5;
  EXPECT_EQ(run(job).read_backs, run(square_job(3)).read_backs);
  job.programs[0].bindings[2].name = "Misnamed";
  const Error error = error_of(job);
  EXPECT_EQ(error.id, "backend.binding-contract");
  EXPECT_THAT(error.message, AllOf(HasSubstr("uniform_buffer 'Scale' in slot 0"), HasSubstr("program 'body'")));
}

TEST(OpenGlBackend, LimitsAreNamed) {
  Job job = square_job(3);
  job.buffers[2].size = std::size_t{1} << 28;
  job.buffers[2].data.clear();
  EXPECT_EQ(error_of(job).id, "backend.limit");
  EXPECT_THAT(error_of(job).message, HasSubstr("uniform_buffer 'scale' is 268435456; this OpenGL driver allows"));
  job = square_job(3);
  job.programs[0].bindings[2].gl_slot = 100000;
  EXPECT_EQ(error_of(job).id, "backend.limit");
  EXPECT_THAT(error_of(job).message, HasSubstr("'Scale'"));
}

/// How many of the first object names of the current context are in use.
int live_objects() {
  using Is = GLboolean (**)(GLuint);  // libepoxy's entry points are pointers to functions
  int count = 0;
  for (const char* name : {"epoxy_glIsBuffer", "epoxy_glIsTexture", "epoxy_glIsSampler", "epoxy_glIsFramebuffer",
                           "epoxy_glIsVertexArray", "epoxy_glIsQuery", "epoxy_glIsShader", "epoxy_glIsProgram"}) {
    const auto is = reinterpret_cast<Is>(dlsym(RTLD_DEFAULT, name));
    for (GLuint i = 1; i < 1000; ++i) count += (*is)(i);
  }
  return count;
}

TEST(OpenGlExecution, OnlyProgramsOutliveTheJob) {
  const auto context = opengl::Context::open({});
  ASSERT_TRUE(context);
  const opengl::CurrentContext scope(**context);
  Job job = square_job(3);
  sample_texture(job, "unused", {});
  const opengl::ExecutionOptions options{opengl::query_limits(), false};
  RecentPrograms<opengl::Program> recent;
  const auto drop = [](std::size_t, std::span<const std::byte>) {};
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(opengl::run_job(
        job, options, recent, [] {}, drop));
    EXPECT_FALSE(opengl::run_job(
        wrong_primitive_job(), options, recent, [] {}, drop));
    EXPECT_EQ(live_objects(), 2) << "the two programs";
  }
  recent.clear();
  EXPECT_EQ(live_objects(), 0);
  // The count sees what is there: two buffers, a texture and its sampler.
  job.buffers.pop_back();
  const opengl::Resources resources = opengl::upload_resources(job);
  EXPECT_EQ(live_objects(), 4);
}

TEST(OpenGlProbe, AMissingLibraryIsNamed) {
  EXPECT_EQ(opengl::missing_library({{"libEGL.so.1"}, {"libnothing.so.7", "libGL.so.1"}}), "");
  EXPECT_EQ(opengl::missing_library({{"libEGL.so.1"}, {"libnothing.so.7", "libnone.so.0"}}),
            "the driver library libnothing.so.7 or libnone.so.0 is not installed");
}

void print_probe_without(const char* variable) {
  setenv(variable, "/nonexistent", 1);
  for (const BackendInfo& info : list_backends()) {
    if (info.name == "opengl") std::fprintf(stderr, "available=%d reason=%s\n", info.available, info.reason.c_str());
  }
  const auto backend = open_backend("opengl");
  std::fprintf(stderr, "%s\n", backend ? "opened" : format(backend.error()).c_str());
  std::exit(0);
}

class OpenGlProbeDeathTest : public testing::Test {
 protected:
  // A fresh process: EGL reads its environment once.
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(OpenGlProbeDeathTest, WithoutAVendorEglFindsNoDriver) {
  EXPECT_EXIT(print_probe_without("__EGL_VENDOR_LIBRARY_FILENAMES"), testing::ExitedWithCode(0),
              "available=0 reason=EGL finds no driver.*\n.*backend.unavailable");
}

TEST_F(OpenGlProbeDeathTest, WithoutItsDriverFileEglDoesNotInitialise) {
  EXPECT_EXIT(print_probe_without("LIBGL_DRIVERS_PATH"), testing::ExitedWithCode(0),
              "available=0 reason=no driver offers OpenGL 4.5 core: .*eglInitialize gives");
}

TEST_F(OpenGlProbeDeathTest, WithADriverTheSameProbeSucceeds) {
  EXPECT_EXIT(print_probe_without("RELIEVO_UNUSED_VARIABLE"), testing::ExitedWithCode(0),
              "available=1 reason=\nopened");
}

}  // namespace
}  // namespace relievo
