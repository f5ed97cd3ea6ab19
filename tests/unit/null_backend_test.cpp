#include "backends/null/null_backend.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Two objects of each kind, so that a failure in the middle leaves some created.
Job small_job() {
  Job job;
  job.name = "small";
  const ShaderCode code = {ShaderStage::compute, {1}, {}};
  job.programs = {{"fill", {code}, {{ResourceKind::storage_buffer, 0, 0, "Out", 0}}, {}}, {"idle", {code}, {}, {}}};
  job.buffers = {{"out", 12, {}}, {"spare", 4, {}}};
  job.textures.resize(1);
  job.textures[0].name = "map";
  job.textures[0].width = 3;
  job.commands = {Dispatch{0, {{0, 0, 0}}, {4, 2, 1}}, Dispatch{1, {}, {1, 1, 1}}};
  job.read_backs = {{ReadBack::Source::buffer, 0, 0}, {ReadBack::Source::texture, 0, 0}};
  return job;
}

NullBackend open_failing_at(int call) {
  BackendOptions options;
  options.fail_at_call = call;
  return NullBackend(options);
}

TEST(NullBackend, RecordsEveryCall) {
  NullBackend backend = open_failing_at(-1);
  ASSERT_TRUE(backend.execute(small_job()));
  EXPECT_THAT(backend.log(),
              ElementsAre("create program \"fill\"", "create program \"idle\"", "create buffer \"out\" of 12 bytes",
                          "create buffer \"spare\" of 4 bytes", "create texture \"map\" of 3x1x1 rgba8_unorm, 1 levels",
                          "dispatch \"fill\" 4x2x1", "dispatch \"idle\" 1x1x1", "read back buffer \"out\"",
                          "read back texture \"map\" level 0"));
}

TEST(NullBackend, ReadsBackZeros) {
  NullBackend backend = open_failing_at(-1);
  const Result<JobResult> result = backend.execute(small_job());
  ASSERT_TRUE(result);
  EXPECT_THAT(result->read_backs, ElementsAre(std::vector<std::byte>(12), std::vector<std::byte>(12)));
}

TEST(NullBackend, FailsAtEveryCallAndLeaksNothing) {
  NullBackend counting = open_failing_at(-1);
  ASSERT_TRUE(counting.execute(small_job()));
  const int calls = static_cast<int>(counting.log().size());
  ASSERT_GT(calls, 0);
  for (int call = 0; call < calls; ++call) {
    NullBackend backend = open_failing_at(call);
    const Result<JobResult> result = backend.execute(small_job());
    ASSERT_FALSE(result) << call;
    EXPECT_EQ(result.error().id, "backend.injected");
    EXPECT_THAT(result.error().message, HasSubstr(counting.log()[static_cast<std::size_t>(call)]));
    EXPECT_EQ(backend.log().size(), static_cast<std::size_t>(call) + 1);
    EXPECT_EQ(backend.live_objects(), 0);
  }
  NullBackend beyond = open_failing_at(calls);
  EXPECT_TRUE(beyond.execute(small_job()));
}

TEST(NullBackend, RejectsAnInvalidJobBeforeAnyCall) {
  Job job = small_job();
  job.read_backs[0].index = 5;
  NullBackend backend = open_failing_at(0);
  const Result<JobResult> result = backend.execute(job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().id, "job.index");
  EXPECT_TRUE(backend.log().empty());
}

TEST(OpenBackend, OpensTheNullBackend) {
  const auto backend = open_backend("null");
  ASSERT_TRUE(backend);
  EXPECT_EQ((*backend)->info().name, "null");
  EXPECT_TRUE((*backend)->info().available);
}

TEST(OpenBackend, SuggestsTheNearestName) {
  const auto backend = open_backend("nul");
  ASSERT_FALSE(backend);
  EXPECT_EQ(backend.error().id, "backend.unknown");
  EXPECT_THAT(backend.error().message, HasSubstr("did you mean \"null\"?"));
}

TEST(OpenBackend, ListsTheKnownNamesWhenNoneIsNear) {
  const auto backend = open_backend("something-else");
  ASSERT_FALSE(backend);
  EXPECT_THAT(backend.error().message, HasSubstr("known backends are"));
}

TEST(ListBackends, NamesEveryBackendOnceAndSaysWhyOneIsMissing) {
  std::set<std::string> names;
  for (const BackendInfo& info : list_backends()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_EQ(info.available, info.reason.empty()) << info.name;
  }
  EXPECT_TRUE(names.contains("null"));
}

}  // namespace
}  // namespace relievo
