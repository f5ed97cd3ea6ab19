/// What the subcommands share in figures and settings.
#include <gtest/gtest.h>

#include <limits>

#include "common.hpp"
#include "support/height_maps.hpp"

namespace relievo::cli {
namespace {

TEST(CliMedian, IsTheMiddleOrTheMeanOfTheTwoInTheMiddle) {
  EXPECT_EQ(median({}), -1);
  EXPECT_EQ(median({9, 1, 5}), 5);
  EXPECT_EQ(median({9, 1}), 5);
  EXPECT_EQ(median({8, 100, 2, 4}), 6);
}

TEST(CliPercent, RoundsNothingToNothing) {
  EXPECT_EQ(percent_text(0), "0");
  EXPECT_EQ(percent_text(1e-6), "<0.001");
  EXPECT_EQ(percent_text(0.0005), "0.001");
  EXPECT_EQ(percent_text(12.3456), "12.346");
  EXPECT_EQ(percent_text(std::numeric_limits<double>::quiet_NaN()), "–");
  EXPECT_EQ(error_text(std::numeric_limits<double>::quiet_NaN()), "–");
}

TEST(CliScale, GoesToTheRaysAndToTheMapsThatAreBakedForIt) {
  const Registry registry = *load_registry();
  std::map<std::string, double> values = {{"normal.scale", 0.3}};
  set_scale(registry, 0.25, test::ramp_map(8, 16), values);
  EXPECT_EQ(values.at("ray.scale"), 0.25);
  EXPECT_EQ(values.at("distance_field.scale"), 0.125) << "in longer sides";
  EXPECT_EQ(values.at("normal.scale"), 0.3) << "what is given stays";
}

TEST(CliScale, StaysWithinTheRange) {
  const Registry registry = *load_registry();
  std::map<std::string, double> values;
  set_scale(registry, 1e-9, test::ramp_map(8, 8), values);
  for (const auto& [name, value] : values) EXPECT_EQ(value, 1e-6) << name;
}

}  // namespace
}  // namespace relievo::cli
