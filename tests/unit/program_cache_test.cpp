/// Programs of Jobs that a cache keeps are those that compiling gives, and only those.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "relievo/program_cache.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

class MapCache : public Cache {
 public:
  std::optional<std::string> load(const CacheKey& key) override {
    const auto found = entries.find(key);
    if (found == entries.end()) return std::nullopt;
    ++counts_.hits;
    return found->second;
  }
  void store(const CacheKey& key, std::string_view payload) override {
    ++counts_.stores;
    entries[key] = payload;
  }
  CacheCounts counts() const override { return counts_; }

  std::map<CacheKey, std::string> entries;

 private:
  CacheCounts counts_;
};

class ProgramCache : public ::testing::Test {
 protected:
  ProgramCache() { use_program_cache(cache); }
  ~ProgramCache() override { use_program_cache(nullptr); }

  std::shared_ptr<MapCache> cache = std::make_shared<MapCache>();
};

Permutation relief_with(double linear_steps, BindingTime binding = BindingTime::uniform) {
  Permutation permutation;
  permutation.stage = "ray";
  permutation.roles["view"] = "relief";
  permutation.values["relief.linear_steps"] = linear_steps;
  permutation.binding_times["relief.linear_steps"] = binding;
  return permutation;
}

/// The program as bytes: equal programs, equal bytes.
std::vector<std::uint8_t> bytes_of(const Permutation& permutation, const char* target = "spirv") {
  const Result<PreparedProgram> prepared = prepare(registry(), permutation, target);
  if (!prepared) {
    ADD_FAILURE() << format(prepared.error());
    return {};
  }
  Job job;
  job.programs.push_back(prepared->program);
  return serialize_job(job);
}

TEST_F(ProgramCache, AKeptProgramIsTheCompiledOne) {
  for (const char* target : {"spirv", "glsl-450"}) {
    const auto compiled = bytes_of(relief_with(30), target);
    const std::uint64_t hits = cache->counts().hits;
    EXPECT_EQ(bytes_of(relief_with(30), target), compiled) << target;
    EXPECT_EQ(cache->counts().hits, hits + 1) << target;
  }
  EXPECT_EQ(cache->entries.size(), 2U);
}

TEST_F(ProgramCache, ValuesOfUniformsShareAnEntry) {
  bytes_of(relief_with(30));
  bytes_of(relief_with(31));
  EXPECT_EQ(cache->entries.size(), 1U);
}

TEST_F(ProgramCache, AKeptProgramHasItsOwnSpecializationConstants) {
  bytes_of(relief_with(31, BindingTime::specialization));
  bytes_of(relief_with(30, BindingTime::specialization));
  const auto kept = bytes_of(relief_with(31, BindingTime::specialization));
  EXPECT_EQ(cache->counts().hits, 1U);
  use_program_cache(nullptr);
  EXPECT_EQ(bytes_of(relief_with(31, BindingTime::specialization)), kept);
  EXPECT_NE(bytes_of(relief_with(30, BindingTime::specialization)), kept);
}

TEST_F(ProgramCache, WhatIsInTheTextHasAnEntryOfItsOwn) {
  bytes_of(relief_with(30, BindingTime::macro));
  bytes_of(relief_with(31, BindingTime::macro));
  EXPECT_EQ(cache->entries.size(), 2U);
}

TEST_F(ProgramCache, ADamagedEntryIsCompiledAnewAndReplaced) {
  const auto compiled = bytes_of(relief_with(30));
  const std::string good = cache->entries.begin()->second;
  for (const std::string& bad : {std::string(), std::string("no job"), good.substr(0, good.size() / 2)}) {
    cache->entries.begin()->second = bad;
    EXPECT_EQ(bytes_of(relief_with(30)), compiled);
    EXPECT_EQ(cache->entries.begin()->second, good);
  }
}

TEST_F(ProgramCache, AProgramThatDoesNotCompileIsNotKept) {
  ASSERT_FALSE(prepare(registry(), relief_with(30), "glsl-110"));
  EXPECT_TRUE(cache->entries.empty());
}

}  // namespace
}  // namespace relievo::test
