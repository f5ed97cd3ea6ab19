/// Maps that are larger than a backend's storage buffers are baked into several, or in several Jobs, to the same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "support/height_maps.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {
namespace {

/// A backend whose storage buffers are small. Says what the largest was, and what one Job took.
class SmallBuffers : public Backend {
 public:
  SmallBuffers(Backend& real, std::size_t limit) : real_(real), info_(real.info()) { info_.max_storage_buffer = limit; }
  const BackendInfo& info() const override { return info_; }
  Result<JobResult> execute(const Job& job) override {
    ++jobs;
    for (const Command& command : job.commands) inspect(job, std::get<Dispatch>(command));
    Result<JobResult> result = real_.execute(job);
    if (result && exchange) std::swap(result->read_backs.front(), result->read_backs.back());
    return result;
  }

  bool exchange = false;                        ///< a seeded fault: the first part of the map for the last
  std::size_t largest = 0, most = 0, jobs = 0;  ///< bytes, buffers of a dispatch

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

/// With mirror, the layers of every map that has several passes read one another.
TEST(LargeBake, EveryMapHasTheSameBytesInSeveralBuffers) {
  const HeightMap height = with_address(white_noise_map(33, 20), AddressMode::mirror);
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
        EXPECT_GE(small.most * small.jobs, buffers) << map;
      }
    }
  }
}

/// Bakes a map from its inputs in `whole` with room for so many of its layers in a buffer.
MapTexels bake_apart(SmallBuffers& small, const Registry& from, const std::string& map, const MapSet& whole) {
  MapSet maps = whole;
  maps.erase(map);
  const Status status = bake_map(small, from, map, maps);
  EXPECT_TRUE(status) << (status ? "" : format(status.error()));
  return status ? maps.at(map).texels : MapTexels();
}

std::size_t layer_bytes(const MapData& map) {
  return texel_count(map) / static_cast<std::size_t>(map.depth) * static_cast<std::size_t>(map.channels) *
         sizeof(float);
}

TEST(LargeBake, LayersThatReadNoOtherHaveTheSameBytesInSeveralJobs) {
  const std::vector<std::string> names = {"quadrant_maxima", "directional_cone", "distance_field"};
  for (const AddressMode mode : {AddressMode::repeat, AddressMode::clip}) {
    const HeightMap height = with_address(white_noise_map(13, 20), mode);
    const MapSet whole = bake_all(backend("vulkan"), height, names);
    for (const std::string& map : names) {
      if (map == "directional_cone" && mode == AddressMode::clip) continue;
      const MapData& data = whole.at(map);
      SmallBuffers small(backend("vulkan"), 3 * layer_bytes(data));
      EXPECT_EQ(bake_apart(small, registry(), map, whole), data.texels) << map << to_string(mode);
      EXPECT_EQ(small.jobs, static_cast<std::size_t>(data.depth + 2) / 3) << map;
      EXPECT_EQ(small.most, 1U) << map;
    }
  }
}

/// The check above sees layers that are kept apart and should not be: a wrong index reads 0, by robust access.
TEST(LargeBake, LayersThatReadOthersAreCaughtWhereTheyAreApart) {
  Registry wrong = registry();
  for (const auto& [map, mode] : std::map<std::string, AddressMode>{{"quadrant_maxima", AddressMode::mirror},
                                                                    {"directional_cone", AddressMode::clip}}) {
    const MapSet whole = bake_all(backend("vulkan"), with_address(white_noise_map(13, 20), mode), {map});
    wrong.maps.at(map).layers_apart.emplace_back(to_string(mode));
    SmallBuffers small(backend("vulkan"), layer_bytes(whole.at(map)));
    EXPECT_NE(bake_apart(small, wrong, map, whole), whole.at(map).texels) << map;
  }
}

/// The checks above see a buffer that is too large, and parts that changed places.
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
