#include <gtest/gtest.h>

#include <set>

#include "relievo/compile.hpp"

namespace relievo {
namespace {

TEST(CompileTargets, EveryNameParsesBackToItsTarget) {
  std::set<std::string> names;
  for (const Target& target : all_targets()) {
    const auto parsed = parse_target(to_string(target));
    ASSERT_TRUE(parsed) << parsed.error().message;
    EXPECT_EQ(*parsed, target);
    names.insert(to_string(target));
  }
  EXPECT_EQ(names, (std::set<std::string>{"spirv-1.0", "glsl-330", "glsl-430", "glsl-450", "essl-300", "essl-310",
                                          "hlsl-5.0", "hlsl-5.1", "hlsl-6.0", "msl-2.2"}));
}

TEST(CompileTargets, AnUnknownNameNamesTheNearest) {
  const auto parsed = parse_target("hlsl-5.2");
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().id, "compile.unknown-target");
  EXPECT_EQ(exit_code(parsed.error().code), 1);
  EXPECT_NE(parsed.error().message.find("'hlsl-5."), std::string::npos) << parsed.error().message;
}

TEST(CompileTargets, ANameNearNothingListsThemAll) {
  const auto parsed = parse_target("webassembly text format");
  ASSERT_FALSE(parsed);
  EXPECT_NE(parsed.error().message.find("spirv-1.0, glsl-330"), std::string::npos) << parsed.error().message;
}

TEST(CompileTargets, FileExtensionsFollowTheLanguage) {
  EXPECT_EQ(file_extension(*parse_target("spirv-1.0")), ".spv");
  EXPECT_EQ(file_extension(*parse_target("glsl-330")), ".glsl");
  EXPECT_EQ(file_extension(*parse_target("essl-310")), ".glsl");
  EXPECT_EQ(file_extension(*parse_target("hlsl-6.0")), ".hlsl");
  EXPECT_EQ(file_extension(*parse_target("msl-2.2")), ".metal");
}

}  // namespace
}  // namespace relievo
