#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "job/recent_programs.hpp"
#include "support/files.hpp"
#include "support/jobs.hpp"

namespace relievo {
namespace {

using namespace test;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string squares = R"(
layout(local_size_x = 4) in;
layout(std430, set = 0, binding = 0) buffer Result { uint result[]; };
void main() { result[gl_GlobalInvocationID.x] += gl_GlobalInvocationID.x * gl_GlobalInvocationID.x; }
)";

Job squares_job() {
  return make_compute_job(make_compute("squares", squares), 16);
}

std::unique_ptr<Backend> open_vulkan(const BackendOptions& options) {
  auto backend = open_backend("vulkan", options);
  if (!backend) throw std::runtime_error(backend.error().message);
  return *std::move(backend);
}

TEST(VulkanInfo, NamesDeviceDriverAndFeatures) {
  const BackendInfo& info = vulkan().info();
  EXPECT_TRUE(info.available);
  EXPECT_EQ(info.shader_target, "spirv");
  EXPECT_FALSE(info.device.empty());
  EXPECT_FALSE(info.driver.empty());
  EXPECT_THAT(info.api_version, testing::StartsWith("1.3."));
  for (const char* feature :
       {"compute", "geometry", "tessellation", "explicit_lod", "texture_3d", "gather", "vertex_texture",
        "dynamic_loops", "depth_write", "timestamps", "linear_float32", "validation", "extended_images"}) {
    EXPECT_THAT(info.features, Contains(feature));
  }
}

TEST(VulkanInfo, SaysWhetherTheDriverRunsOnTheCpu) {
  const BackendInfo& info = vulkan().info();
  EXPECT_EQ(info.features.contains("software"), info.device.find("llvmpipe") != std::string::npos);
}

TEST(VulkanInfo, ProbeAgreesWithTheOpenedBackend) {
  const std::vector<BackendInfo> all = list_backends();
  const auto probed = std::find_if(all.begin(), all.end(), [](const auto& info) { return info.name == "vulkan"; });
  ASSERT_NE(probed, all.end());
  EXPECT_EQ(probed->device, vulkan().info().device);
  EXPECT_EQ(probed->features, vulkan().info().features);
}

TEST(VulkanOpen, SelectsADeviceByPartOfItsName) {
  BackendOptions options;
  options.device = vulkan().info().device.substr(2, 5);
  EXPECT_EQ(open_vulkan(options)->info().device, vulkan().info().device);
}

TEST(VulkanOpen, RefusesADeviceThatIsNotThere) {
  BackendOptions options;
  options.device = "no such device";
  const auto backend = open_backend("vulkan", options);
  ASSERT_FALSE(backend);
  EXPECT_EQ(backend.error().id, "backend.device");
  EXPECT_THAT(backend.error().message, HasSubstr("no such device"));
  EXPECT_THAT(backend.error().message, HasSubstr(vulkan().info().device));
}

TEST(VulkanOpen, OpensAgainAfterClosing) {
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(open_vulkan({})->execute(squares_job()));
}

/// A graphics card's memory is copied to and from, even if this machine's device shares the host's.
TEST(VulkanBuffers, CopiesHoldWhatSharedMemoryHolds) {
  BackendOptions options;
  options.validation = true;
  options.copies_always = true;
  const auto copying = open_vulkan(options);
  for (const std::size_t size : {16, 4000}) {
    Job job = squares_job();
    job.buffers = {make_buffer("empty", size), make_buffer("full", std::vector<std::uint32_t>(size / 4, 7))};
    job.commands = {Dispatch{0, {{0, 0, 0}}, {1, 1, 1}}, Dispatch{0, {{0, 0, 1}}, {1, 1, 1}}};
    job.read_backs = {{ReadBack::Source::buffer, 1, 0}, {ReadBack::Source::buffer, 0, 0}};
    const Result<JobResult> copied = copying->execute(job);
    ASSERT_TRUE(copied) << copied.error().message;
    EXPECT_THAT(copied->messages, IsEmpty());
    EXPECT_EQ(copied->read_backs, run(job).read_backs);
    const auto values = from_bytes<std::uint32_t>(copied->read_backs[0]);
    ASSERT_EQ(values.size(), size / 4);
    EXPECT_THAT(std::vector(values.begin(), values.begin() + 4), ElementsAre(7, 8, 11, 16));
  }
}

/// Prints why Vulkan is not available and how opening it fails, then leaves.
[[noreturn]] void report_and_exit(const BackendOptions& options = {}) {
  for (const BackendInfo& info : list_backends()) {
    if (info.name == "vulkan" && !info.available) std::cerr << "reason: " << info.reason << "\n";
  }
  const auto backend = open_backend("vulkan", options);
  if (!backend) std::cerr << "id: " << backend.error().id << "\n";
  std::_Exit(backend ? 1 : exit_code(backend.error().code));
}

[[noreturn]] void exit_without_driver() {
  setenv("VK_DRIVER_FILES", "/nonexistent/icd.json", 1);
  setenv("VK_ICD_FILENAMES", "/nonexistent/icd.json", 1);
  report_and_exit();
}

[[noreturn]] void exit_without_loader() {
  const rlimit no_new_files = {0, 0};  // so that the library cannot be opened
  setrlimit(RLIMIT_NOFILE, &no_new_files);
  report_and_exit();
}

[[noreturn]] void exit_without_layer() {
  setenv("VK_LAYER_PATH", "/nonexistent", 1);
  BackendOptions options;
  options.validation = true;
  report_and_exit(options);
}

// A driver list is read once a process, so these need one of their own.
class VulkanOpenDeathTest : public testing::Test {
 protected:
  void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

TEST_F(VulkanOpenDeathTest, SaysThatThereIsNoDriver) {
  EXPECT_EXIT(exit_without_driver(), testing::ExitedWithCode(3),
              "reason: The Vulkan loader finds no driver\nid: backend.unavailable");
}

TEST_F(VulkanOpenDeathTest, SaysThatThereIsNoLoader) {
  EXPECT_EXIT(exit_without_loader(), testing::ExitedWithCode(3),
              "reason: The Vulkan loader .libvulkan.so.1. cannot be opened\nid: backend.unavailable");
}

TEST_F(VulkanOpenDeathTest, SaysThatTheValidationLayerIsMissing) {
  EXPECT_EXIT(exit_without_layer(), testing::ExitedWithCode(3), "id: backend.validation-missing");
}

TEST(VulkanCompute, WritesABufferThatStartsAsZero) {
  Job job = squares_job();
  std::get<Dispatch>(job.commands[0]).groups[0] = 1;
  EXPECT_THAT(from_bytes<std::uint32_t>(run(job).read_backs[0]), ElementsAre(0, 1, 4, 9));
}

TEST(VulkanCompute, SeesTheContentsOfItsBuffers) {
  Job job = squares_job();
  job.buffers[0].data = to_bytes(std::vector<std::uint32_t>{10, 20, 30, 40});
  EXPECT_THAT(from_bytes<std::uint32_t>(run(job).read_backs[0]), ElementsAre(10, 21, 34, 49));
}

TEST(VulkanCompute, AJobThatIsNotNeededAgainRunsTheSame) {
  Job job = squares_job();
  job.buffers[0].data = to_bytes(std::vector<std::uint32_t>{10, 20, 30, 40});
  const auto backend = open_backend("vulkan");
  ASSERT_TRUE(backend) << format(backend.error());
  std::vector<Bytes> taken;
  const Result<JobResult> once = (*backend)->execute_once(
      job, [&](std::size_t, std::span<const std::byte> bytes) { taken.emplace_back(bytes.begin(), bytes.end()); });
  ASSERT_TRUE(once) << format(once.error());
  EXPECT_THAT(once->read_backs, IsEmpty());
  EXPECT_EQ(taken, run(job).read_backs);
  free_contents(job);
  EXPECT_THAT(from_bytes<std::uint32_t>(run(job).read_backs[0]), ElementsAre(0, 1, 4, 9));
}

TEST(VulkanCompute, LaterCommandsSeeWhatEarlierOnesWrote) {
  Job job = squares_job();
  job.commands.assign(50, job.commands[0]);
  EXPECT_THAT(from_bytes<std::uint32_t>(run(job).read_backs[0]), ElementsAre(0, 50, 200, 450));
}

TEST(VulkanCompute, ZeroesTheLastBytesOfAnOddBuffer) {
  Job job;
  job.name = "odd";
  job.buffers = {make_buffer("odd", 7), make_buffer("given", std::vector<std::uint8_t>{1, 2, 3})};
  job.read_backs = {{ReadBack::Source::buffer, 0, 0}, {ReadBack::Source::buffer, 1, 0}};
  const JobResult result = run(job);
  EXPECT_EQ(result.read_backs[0], Bytes(7));
  EXPECT_EQ(result.read_backs[1], job.buffers[1].data);
}

TEST(VulkanCompute, BindsByContractAcrossAGapInTheSets) {
  const std::string body = R"(
layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 0) buffer Result { vec4 result; };
layout(std140, set = 2, binding = 3) uniform Scale { vec4 scale; };
layout(std430, set = 2, binding = 1) readonly buffer Offset { vec4 offset; };
void main() { result = 2.0 * scale + offset; }
)";
  Job job = make_compute_job(make_compute("gap", body,
                                          {{ResourceKind::uniform_buffer, 2, 3, "Scale", 0},
                                           {ResourceKind::storage_buffer, 2, 1, "Offset", 1}}),
                             16);
  job.buffers.push_back(make_buffer("scale", std::vector<float>{1, 2, 3, 4}));
  job.buffers.push_back(make_buffer("offset", std::vector<float>{0.5f, 0.5f, 0.5f, 8}));
  std::get<Dispatch>(job.commands[0]).resources = {{2, 3, 1}, {0, 0, 0}, {2, 1, 2}};
  EXPECT_THAT(from_bytes<float>(run(job).read_backs[0]), ElementsAre(2.5f, 4.5f, 6.5f, 16.0f));
}

TEST(VulkanCompute, AppliesSpecializationConstants) {
  const std::string body = R"(
layout(local_size_x = 1) in;
layout(constant_id = 3) const int count = 1;
layout(constant_id = 7) const float gain = 1.0;
layout(constant_id = 8) const float kept = 42.0;
layout(std430, set = 0, binding = 0) buffer Result { float result[3]; };
void main() { result[0] = float(count); result[1] = gain; result[2] = kept; }
)";
  Job job = make_compute_job(make_compute("constants", body), 12);
  const float gain = 0.25f;
  std::uint32_t gain_bits = 0;
  std::memcpy(&gain_bits, &gain, sizeof gain);
  job.programs[0].constants = {{7, gain_bits}, {3, static_cast<std::uint32_t>(-5)}, {99, 1}};
  EXPECT_THAT(from_bytes<float>(run(job).read_backs[0]), ElementsAre(-5.0f, 0.25f, 42.0f));
}

TEST(VulkanCompute, KeptProgramsAreNotTakenForOneAnother) {
  const std::string body = R"(
layout(local_size_x = 1) in;
layout(constant_id = 3) const uint value = 1u;
layout(std430, set = 0, binding = 0) buffer Result { uint result; };
void main() { result = value; }
)";
  const Job first = make_compute_job(make_compute("constant", body), 4);
  for (std::uint32_t round = 0; round < 2; ++round) {
    for (std::uint32_t i = 0; i < RecentPrograms<int>::capacity + 3; ++i) {
      Job job = first;
      job.programs[0].constants = {{3, i}};
      EXPECT_THAT(from_bytes<std::uint32_t>(run(job).read_backs[0]), ElementsAre(i));
    }
  }
}

TEST(VulkanCompute, TwoRunsAreByteIdentical) {
  const Job job = squares_job();
  EXPECT_EQ(run(job).read_backs, run(job).read_backs);
}

TEST(VulkanCompute, ASerialisedJobRunsTheSame) {
  const Job job = squares_job();
  const Result<Job> parsed = parse_job(serialize_job(job));
  ASSERT_TRUE(parsed);
  EXPECT_EQ(run(*parsed).read_backs, run(job).read_backs);
}

TEST(VulkanCompute, RunsAnEmptyJob) {
  EXPECT_THAT(run({}).read_backs, IsEmpty());
}

TEST(VulkanTimestamps, MeasureEachCommand) {
  const std::string body = R"(
layout(local_size_x = 64) in;
layout(constant_id = 0) const int count = 1;
layout(std430, set = 0, binding = 0) buffer Result { uint result[]; };
void main() {
  uint value = gl_GlobalInvocationID.x;
  for (int i = 0; i < count; ++i) value = value * 1664525u + 1013904223u;
  result[gl_GlobalInvocationID.x & 63u] = value;
}
)";
  Job job = make_compute_job(make_compute("spin", body), 256);
  job.programs.push_back(job.programs[0]);
  job.programs[1].constants = {{0, 20000}};
  Dispatch longer = std::get<Dispatch>(job.commands[0]);
  longer.program = 1;
  longer.groups[0] = 200;
  job.commands.emplace_back(longer);
  const auto start = std::chrono::steady_clock::now();
  const std::vector<double> seconds = run(job).command_seconds;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(seconds.size(), 2u);
  EXPECT_GE(seconds[0], 0);
  EXPECT_GT(seconds[1], seconds[0]);
  EXPECT_LT(seconds[0] + seconds[1], elapsed.count());
  RecordProperty("short_seconds", std::to_string(seconds[0]));
  RecordProperty("long_seconds", std::to_string(seconds[1]));
}

TEST(VulkanErrors, RefusesAnInvalidJob) {
  Job job = squares_job();
  job.read_backs[0].index = 3;
  const auto result = vulkan().execute(job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().id, "job.index");
}

TEST(VulkanErrors, RefusesDamagedSpirv) {
  Job job = squares_job();
  std::vector<std::uint32_t>& code = job.programs[0].shaders[0].spirv;
  for (const std::size_t position : {std::size_t{0}, code.size() / 2, code.size() - 1}) {
    Job damaged = job;
    damaged.programs[0].shaders[0].spirv[position] = 0xffffffff;
    const auto result = vulkan().execute(damaged);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().id, "backend.spirv");
    EXPECT_THAT(result.error().message, HasSubstr("Job \"squares\": Program \"squares\""));
  }
  code.clear();
  job.programs[0].shaders[0].text["glsl-450"] = "void main() {}";
  const auto result = vulkan().execute(job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().id, "backend.spirv");
}

TEST(VulkanErrors, RefusesATextureBeyondTheDevicesLimits) {
  Job job;
  job.textures = {make_texture("wide", Format::r8_unorm, 1 << 16, 1)};
  const auto result = vulkan().execute(job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().id, "backend.limit");
  EXPECT_THAT(result.error().message, HasSubstr("65536x1x1"));
}

TEST(VulkanErrors, RefusesASetNumberBeyondTheDevicesLimits) {
  Job job = squares_job();
  job.programs[0].bindings.push_back({ResourceKind::storage_buffer, 31, 0, "Far", 1});
  std::get<Dispatch>(job.commands[0]).resources.push_back({31, 0, 0});
  const auto result = vulkan().execute(job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().id, "backend.limit");
}

TEST(VulkanErrors, TheBackendStaysUsableAfterAnError) {
  Job job = squares_job();
  job.programs[0].shaders[0].spirv[0] = 0;
  EXPECT_FALSE(vulkan().execute(job));
  EXPECT_THAT(from_bytes<std::uint32_t>(run(squares_job()).read_backs[0]), ElementsAre(0, 1, 4, 9));
}

/// A folder of its own that goes away with the test.
class VulkanPipelineCache : public testing::Test {
 protected:
  VulkanPipelineCache() { options_.pipeline_cache = (folder_ / "pipelines.bin").string(); }

  void run_once() {
    const auto result = open_vulkan(options_)->execute(squares_job());
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_THAT(result->messages, IsEmpty());
    EXPECT_THAT(from_bytes<std::uint32_t>(result->read_backs[0]), ElementsAre(0, 1, 4, 9));
  }
  std::string contents() const { return test::TemporaryFolder::read(options_.pipeline_cache); }
  void overwrite(const std::string& bytes) const { std::ofstream(options_.pipeline_cache, std::ios::binary) << bytes; }

  test::TemporaryFolder folder_;
  BackendOptions options_;
};

TEST_F(VulkanPipelineCache, IsWrittenAndReadWithoutLeavingOtherFiles) {
  run_once();
  const std::string first = contents();
  EXPECT_GT(first.size(), 32u);
  run_once();
  EXPECT_EQ(contents(), first);
  EXPECT_EQ(static_cast<int>(folder_.count()), 1);
}

TEST_F(VulkanPipelineCache, IgnoresADamagedFileAndReplacesIt) {
  run_once();
  const std::string whole = contents();
  std::string flipped = whole;
  flipped.back() = static_cast<char>(flipped.back() ^ 1);
  for (const std::string& damaged :
       {std::string(), whole.substr(0, 5), whole.substr(0, whole.size() - 1), flipped, std::string(100000, 'x')}) {
    overwrite(damaged);
    run_once();
    EXPECT_EQ(contents(), whole);
  }
}

TEST_F(VulkanPipelineCache, SaysWhenItCannotBeWritten) {
  options_.pipeline_cache = (folder_ / "missing/pipelines.bin").string();
  const auto result = open_vulkan(options_)->execute(squares_job());
  ASSERT_TRUE(result);
  EXPECT_THAT(result->messages, ElementsAre(HasSubstr("'pipelines.bin' cannot be written")));
}

}  // namespace
}  // namespace relievo
