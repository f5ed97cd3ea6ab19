/// Maps that are larger than a backend's storage buffers are baked into several, to the same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "support/height_maps.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

/// A backend whose storage buffers are small. Says what the largest was.
class SmallBuffers : public Backend {
 public:
  SmallBuffers(Backend& real, std::size_t limit) : real_(real), info_(real.info()) { info_.max_storage_buffer = limit; }
  const BackendInfo& info() const override { return info_; }
  Result<JobResult> execute(const Job& job) override {
    for (const Command& command : job.commands) inspect(job, std::get<Dispatch>(command));
    Result<JobResult> result = real_.execute(job);
    if (result && exchange) std::swap(result->read_backs.front(), result->read_backs.back());
    return result;
  }

  bool exchange = false;              ///< a seeded fault: the first part of the map for the last
  std::size_t largest = 0, most = 0;  ///< bytes, buffers of a dispatch

 private:
  void inspect(const Job& job, const Dispatch& dispatch) {
    std::size_t buffers = 0;
    for (const ResourceBinding& bound : dispatch.resources) {
      for (const BindingSlot& slot : job.programs[static_cast<std::size_t>(dispatch.program)].bindings) {
        if (slot.set != bound.set || slot.binding != bound.binding || slot.kind != ResourceKind::storage_buffer)
          continue;
        ++buffers;
        largest = std::max(largest, job.buffers[static_cast<std::size_t>(bound.resource)].size);
      }
    }
    most = std::max(most, buffers);
  }

  Backend& real_;
  BackendInfo info_;
};

MapSet bake_all(Backend& on, const HeightMap& height, const std::vector<std::string>& names) {
  MapSet maps = map_set(height);
  std::vector<std::string> messages;
  for (const std::string& name : names) {
    const Status status = bake_map(on, registry(), name, maps, {}, &messages);
    EXPECT_TRUE(status) << (status ? "" : format(status.error()));
  }
  EXPECT_THAT(messages, ::testing::IsEmpty());
  return maps;
}

std::vector<std::string> baked_names() {
  std::vector<std::string> names;
  for (const auto& [name, map] : registry().maps) {
    if (!map.module.empty()) names.push_back(name);
  }
  return names;
}

TEST(LargeBake, EveryMapHasTheSameBytesInSeveralBuffers) {
  const HeightMap height = with_address(white_noise_map(33, 20), AddressMode::clamp);
  for (const std::string& name : both_backends) {
    const MapSet whole = bake_all(backend(name), height, baked_names());
    for (const auto& [map, data] : whole) {
      if (map == "height") continue;
      const std::size_t floats = texel_count(data) * static_cast<std::size_t>(data.channels);
      for (const std::size_t buffers : {2, 7}) {  // seven: a texel's channels fall into two buffers
        const std::size_t limit = (floats + buffers - 1) / buffers * sizeof(float);
        SmallBuffers small(backend(name), limit);
        MapSet maps = whole;
        maps.erase(map);
        ASSERT_TRUE(bake_map(small, registry(), map, maps)) << map;
        EXPECT_EQ(maps.at(map).texels, data.texels) << fmt::format("{} in {} buffers on {}", map, buffers, name);
        EXPECT_LE(small.largest, limit) << map;
        EXPECT_EQ(small.most, buffers) << map;
      }
    }
  }
}

/// The check above sees a buffer that is too large, and parts that changed places.
TEST(LargeBake, WholeBuffersAndExchangedOnesAreCaught) {
  const HeightMap height = white_noise_map(16, 16);
  SmallBuffers unlimited(backend("vulkan"), 0), small(backend("vulkan"), 512);
  const MapSet whole = bake_all(unlimited, height, {"normal"});
  EXPECT_EQ(unlimited.most, 1U);
  EXPECT_GT(unlimited.largest, 512U);
  small.exchange = true;
  EXPECT_NE(bake_all(small, height, {"normal"}).at("normal").texels, whole.at("normal").texels);
}

TEST(LargeBake, AMapBeyondEightBuffersIsRefusedWithItsSize) {
  SmallBuffers small(backend("vulkan"), 100);
  MapSet maps = map_set(white_noise_map(16, 16));
  const Status status = bake_map(small, registry(), "normal", maps);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().id, "maps.too-large");
  EXPECT_EQ(status.error().code, ErrorCode::unsupported);
  EXPECT_THAT(status.error().message, ::testing::HasSubstr("expected at most 800 on backend 'vulkan'"));
}

}  // namespace
}  // namespace relievo::test
