/// Jobs that trace several sets of rays with several requests: which command traces what, and what comes back.
#include <gtest/gtest.h>

#include "support/height_maps.hpp"
#include "support/linear_claims.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

class TraceSets : public ::testing::TestWithParam<std::string> {
 protected:
  TraceSets() {
    // As a caller asks for them, and as a backend runs them quicker: the second may keep rays and hits in images.
    requests_ = {request_of("relief"), request_of("linear_search", {{"linear_search.steps", 40}})};
    requests_[1].values = values_on(registry(), on().info(), requests_[1].values);
    for (const TraceRequest& request : requests_) {
      for (const std::string& map : registry().techniques.at(request.technique).maps)
        EXPECT_TRUE(bake_map(on(), registry(), map, maps_));
    }
  }

  Backend& on() const { return backend(GetParam()); }
  std::string target() const { return on().info().shader_target; }

  JobResult run(const Job& job) const {
    Result<JobResult> result = on().execute(job);
    EXPECT_TRUE(result) << format(result.error());
    if (!result) return {};
    EXPECT_THAT(result->messages, ::testing::IsEmpty());
    return *std::move(result);
  }

  std::vector<Hit> trace_alone(std::size_t set, std::size_t request) const {
    const auto job = make_trace_job(registry(), maps_, sets_[set], {&requests_[request], 1}, target());
    EXPECT_TRUE(job) << format(job.error());
    return read_trace(run(*job), sets_[set], 1).at(0).hits;
  }

  Job job_of_all(bool read) const {
    const Result<Job> job = make_trace_job(registry(), maps_, sets_, requests_, target(), {2, false}, read);
    EXPECT_TRUE(job) << format(job.error());
    return job ? *job : Job{};
  }

  const HeightMap map_ = smooth_noise_map(33, 20);
  MapSet maps_ = map_set(map_);
  std::vector<std::vector<Ray>> sets_ = {bounded_rays(map_, 300, 3), bounded_rays(map_, 170, 4)};
  std::vector<TraceRequest> requests_;
};

bool same(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Hit& x, const Hit& y) {
    return x.status == y.status && x.t == y.t && x.u == y.u && x.v == y.v && x.h == y.h && x.steps == y.steps &&
           x.fetches == y.fetches;
  });
}

TEST_P(TraceSets, EveryReadBackHoldsWhatItsSetAndRequestFindAlone) {
  const JobResult result = run(job_of_all(true));
  ASSERT_EQ(result.read_backs.size(), 4u);
  std::vector<std::vector<Hit>> alone;
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t k = 0; k < 2; ++k) {
      alone.push_back(trace_alone(s, k));
      EXPECT_TRUE(same(read_hits(result.read_backs[2 * s + k], sets_[s]), alone.back())) << s << ", " << k;
    }
  }
  EXPECT_FALSE(same(alone[0], alone[1])) << "else requests could change places";
  EXPECT_FALSE(same(alone[2], alone[3]));
}

TEST_P(TraceSets, EveryCommandTracesItsSetWithItsRequest) {
  const Job job = job_of_all(true);
  ASSERT_EQ(job.commands.size(), 8u) << "two repeats";
  for (std::size_t repeat = 0; repeat < 2; ++repeat) {
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::size_t k = 0; k < 2; ++k) {
        Job one = job;
        one.commands = {job.commands[(repeat * 2 + s) * 2 + k]};
        const JobResult result = run(one);
        ASSERT_EQ(result.read_backs.size(), 4u);
        EXPECT_TRUE(same(read_hits(result.read_backs[2 * s + k], sets_[s]), trace_alone(s, k)))
            << "repeat " << repeat << ", set " << s << ", request " << k;
      }
    }
  }
}

TEST_P(TraceSets, AWarmUpTracesTheFirstSetOnceAndIsNotTimed) {
  const TraceRounds rounds{2, true};
  const auto job = make_trace_job(registry(), maps_, sets_, requests_, target(), rounds, true);
  ASSERT_TRUE(job) << format(job.error());
  ASSERT_EQ(job->commands.size(), 10u);
  for (std::size_t k = 0; k < 2; ++k) {
    Job one = *job;
    one.commands = {job->commands[k]};
    const JobResult result = run(one);
    EXPECT_TRUE(same(read_hits(result.read_backs.at(k), sets_[0]), trace_alone(0, k))) << "request " << k;
  }
  JobResult result;
  EXPECT_EQ(trace_seconds(result, 2, 2, rounds), std::vector<std::vector<double>>(4)) << "without timestamps";
  result.command_seconds = {100, 100, 1, 2, 3, 4, 5, 6, 7, 8};
  EXPECT_EQ(trace_seconds(result, 2, 2, rounds), (std::vector<std::vector<double>>{{1, 5}, {2, 6}, {3, 7}, {4, 8}}));
}

TEST_P(TraceSets, WithoutReadHitsNothingComesBackButTimes) {
  const Job job = job_of_all(false);
  EXPECT_EQ(job.commands.size(), 8u);
  EXPECT_TRUE(job.read_backs.empty());
  const JobResult result = run(job), read = run(job_of_all(true));
  EXPECT_TRUE(result.read_backs.empty());
  EXPECT_EQ(result.command_seconds.size(), read.command_seconds.size());
}

TEST_P(TraceSets, NoSetsAreAJobThatDoesNothing) {
  const auto none =
      make_trace_job(registry(), maps_, std::span<const std::vector<Ray>>{}, requests_, target(), {2, false}, true);
  ASSERT_TRUE(none) << format(none.error());
  EXPECT_TRUE(none->commands.empty());
  EXPECT_TRUE(none->read_backs.empty());
  EXPECT_TRUE(run(*none).read_backs.empty());
}

TEST_P(TraceSets, ASetWithoutRaysIsRefused) {
  sets_[1].clear();
  const auto refused = make_trace_job(registry(), maps_, sets_, requests_, target(), {2, false}, true);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().id, "trace.no-rays");
}

INSTANTIATE_TEST_SUITE_P(Backends, TraceSets, ::testing::ValuesIn(both_backends),
                         [](const auto& backend) { return backend.param; });

}  // namespace
}  // namespace relievo::test
