#include "describe/toml_guard.hpp"

#include <gtest/gtest.h>

#include "describe/toml_document.hpp"
#include "unit/describe_examples.hpp"

namespace relievo {
namespace {

std::string repeat(std::string_view text, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) result += text;
  return result;
}

TEST(TomlGuard, AcceptsSixteenLevels) {
  EXPECT_TRUE(guard_toml(repeat("a.", 15) + "a = 1\n", "f"));
  EXPECT_TRUE(guard_toml("a = " + repeat("[", 16) + repeat("]", 16) + "\n", "f"));
}

TEST(TomlGuard, RejectsMoreWithItsPlace) {
  const Status keys = guard_toml(std::string("x = 1\n").append(repeat("a.", 16)) + "a = 1\n", "f.toml");
  ASSERT_FALSE(keys);
  EXPECT_EQ(keys.error().file, "f.toml");
  examples::expect_error(keys.error(), "describe.syntax", 2, 32, "16");
  const Status brackets = guard_toml("a = " + repeat("[", 17) + repeat("]", 17) + "\n", "f");
  ASSERT_FALSE(brackets);
  examples::expect_error(brackets.error(), "describe.syntax", 1, 21, "16");
  EXPECT_FALSE(guard_toml("a = " + repeat("{a = ", 17), "f"));
  EXPECT_FALSE(guard_toml(repeat("\"a\" . ", 17) + "a = 1\n", "f"));
}

TEST(TomlGuard, IgnoresDotsAndBracketsOfStringsAndComments) {
  const std::string noise = repeat(".[{", 40);
  for (const std::string& text : {"a = \"" + noise + "\"\n", "a = '" + noise + "'\n", "# " + noise + "\n",
                                  "a = \"\"\"\n\"" + noise + "\"\"\"\"\n", "a = '''\n" + noise + "'''\n",
                                  "a = \"\\\"" + noise + "\"\n", "a = \"\" # " + noise + "\n"}) {
    EXPECT_TRUE(guard_toml(text, "f")) << text;
    EXPECT_TRUE(parse_toml(text, "f")) << text;
  }
}

TEST(TomlGuard, SeesDotsAfterAString) {
  std::string deep = "\n";
  deep += repeat("a.", 20) + "a = 1\n";
  for (const std::string& text : {"b = \"x\"" + deep, "b = ''" + deep, "b = \"\"\"x\"\"\"\"\"" + deep,
                                  "b = '''x'''" + deep, "b = \"\\\\\"" + deep, "# it's" + deep}) {
    EXPECT_FALSE(guard_toml(text, "f")) << text;
  }
}

TEST(TomlGuard, RejectsCharactersOutsideAsciiWhereTomlHasNone) {
  const auto bare = parse_toml("a = \"\u00e9\" \u00e9\n", "f");
  ASSERT_FALSE(bare);
  examples::expect_error(bare.error(), "describe.syntax", 1, 9, "outside ASCII");
  for (const char* text : {"\u00e9 = 1\n", "a = 1\u00a0\n", "a = \"\"\"x \\\n  \u00e9\"\"\"\n", "a = \"\\\u00e9\"\n"}) {
    EXPECT_FALSE(guard_toml(text, "f")) << text;
  }
}

TEST(TomlGuard, RejectsThemInQuotesThatTomlTakesForPartOfAValue) {
  for (const char* text : {"a = 1\"\u00a7\"\n", "a = [1'\u00a7']\n", "a = true\"\"\"\u00a7\"\"\"\n",
                           "a = 1.\"\u00a7\"\n", "a = \"\"'\u00a7'\n"}) {
    EXPECT_FALSE(guard_toml(text, "f")) << text;
  }
  EXPECT_TRUE(guard_toml("a=[\"\u00a7\",'\u00a7']\nb={c='\u00a7'}\n\"\u00a7\".'d' = 1\n", "f"));
}

TEST(TomlGuard, AcceptsThemInStringsCommentsAndAsAByteOrderMark) {
  for (const char* text : {"a = \"\u00e9\" # \u00e9\n", "a = '\u00e9'\n", "\uFEFFa = 1\n", "\"\u00e9\" = 1\n",
                           "a = \"\"\"\u00e9\\\n  x\u00e9\"\"\"\n", "a = '''\\\u00e9'''\n"}) {
    EXPECT_TRUE(guard_toml(text, "f")) << text;
    EXPECT_TRUE(parse_toml(text, "f")) << text;
  }
}

TEST(TomlGuard, ProtectsTheParserFromDeepKeys) {
  const auto deep = parse_toml(repeat("a.", 400000) + "a = 1\n", "f");
  ASSERT_FALSE(deep);
  EXPECT_EQ(deep.error().id, "describe.syntax");
  EXPECT_EQ(parse_toml(std::string((1 << 20) + 1, ' '), "f").error().id, "describe.syntax");
}

}  // namespace
}  // namespace relievo
