#include <gtest/gtest.h>

#include "relievo/describe.hpp"

namespace relievo {
namespace {

const std::vector<std::string> names = {"relief", "cone_step", "sphere_trace", "parallax"};

TEST(NearestName, FindsAMisspelling) {
  EXPECT_EQ(nearest_name("releif", names), "relief");       // two letters swapped
  EXPECT_EQ(nearest_name("conestep", names), "cone_step");  // one missing
  EXPECT_EQ(nearest_name("paralllax", names), "parallax");  // one too many
  EXPECT_EQ(nearest_name("spheretracer", names), "sphere_trace");
  EXPECT_EQ(nearest_name("relief", names), "relief");
}

TEST(NearestName, IsEmptyWhenNoneIsNear) {
  EXPECT_EQ(nearest_name("tessellation", names), "");
  EXPECT_EQ(nearest_name("relief", {}), "");
  EXPECT_EQ(nearest_name("abc", {"xyz"}), "");
}

TEST(NearestName, AllowsAThirdOfTheLengthButAtLeastTwo) {
  EXPECT_EQ(nearest_name("abcdef", {"abcdxy"}), "abcdxy");
  EXPECT_EQ(nearest_name("abcdef", {"abcxyz"}), "");
  EXPECT_EQ(nearest_name("abcdefghi", {"abcdefxyz"}), "abcdefxyz");
  EXPECT_EQ(nearest_name("abcdefghi", {"abcdewxyz"}), "");
}

TEST(NearestName, PrefersTheNearestThenTheFirst) {
  EXPECT_EQ(nearest_name("linear", {"lineage", "linears", "linearx"}), "linears");
}

TEST(NearestName, CostsLittleForAHugeName) {
  EXPECT_EQ(nearest_name(std::string(1 << 20, 'a'), names), "");
}

}  // namespace
}  // namespace relievo
