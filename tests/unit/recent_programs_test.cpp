#include "job/recent_programs.hpp"

#include <gtest/gtest.h>

namespace relievo {
namespace {

ShaderProgram program(std::uint32_t id) {
  return {"probe", {{ShaderStage::compute, {id}, {}}}, {}, {}};
}

TEST(RecentPrograms, FindWhatWasKeptForTheVerySource) {
  RecentPrograms<int> recent;
  EXPECT_EQ(recent.find(program(1)), nullptr);
  recent.keep(program(1), 10);
  ASSERT_NE(recent.find(program(1)), nullptr);
  EXPECT_EQ(*recent.find(program(1)), 10);
  ShaderProgram other = program(1);
  other.constants = {{0, 1}};
  EXPECT_EQ(recent.find(other), nullptr);
  other = program(1);
  other.bindings = {{ResourceKind::storage_buffer, 0, 1, "Rays", 1}};
  EXPECT_EQ(recent.find(other), nullptr);
  other = program(1);
  other.shaders[0].text["glsl-450"] = "void main() {}";
  EXPECT_EQ(recent.find(other), nullptr);
}

TEST(RecentPrograms, TheOneUsedLongestAgoIsDropped) {
  RecentPrograms<int> recent;
  const int count = static_cast<int>(RecentPrograms<int>::capacity);
  for (int i = 0; i < count; ++i) recent.keep(program(static_cast<std::uint32_t>(i)), i);
  const std::shared_ptr<int> first = recent.find(program(0)), second = recent.find(program(1));
  EXPECT_NE(recent.find(program(0)), nullptr);
  for (int i = count; i < 2 * count - 1; ++i) recent.keep(program(static_cast<std::uint32_t>(i)), i);
  EXPECT_EQ(recent.find(program(1)), nullptr);
  EXPECT_EQ(recent.find(program(0)), first);
  EXPECT_EQ(*second, 1) << "lives as long as somebody holds it";
}

}  // namespace
}  // namespace relievo
