// Whatever the text, a parser gives a valid value or an error with a place: it does not crash, hang or throw.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "support/descriptor_faults.hpp"
#include "unit/describe_examples.hpp"

namespace relievo {
namespace {

using test::fault_of;
using test::fault_of_all;

const std::vector<std::string_view> texts = {examples::technique, examples::map, examples::stage};

TEST(DescriptorRobustness, SurvivesTruncationAtEveryLength) {
  for (const std::string_view text : texts) {
    for (std::size_t length = 0; length <= text.size(); ++length) {
      ASSERT_EQ(fault_of_all(text.substr(0, length)), "") << text.substr(0, length);
    }
  }
}

TEST(DescriptorRobustness, SurvivesRandomBytes) {
  std::mt19937 random(1);
  for (int round = 0; round < 20000; ++round) {
    std::string text(texts[random() % texts.size()]);
    for (unsigned flips = 1 + random() % 4; flips > 0; --flips)
      text[random() % text.size()] = static_cast<char>(random());
    ASSERT_EQ(fault_of_all(text), "") << "round " << round << "\n" << text;
  }
}

TEST(DescriptorRobustness, SurvivesRandomSyntax) {
  std::mt19937 random(2);
  const std::vector<std::string> pieces = {
      "[",          "]",      "{",      "}",      "=",      ".",    ",",    "\"",
      "'",          "\"\"\"", "'''",    "\n",     "#",      "\\",   "-",    "inf",
      "nan",        "1",      "1e",     "0x",     "a",      "name", " ",    "[[",
      "]]",         "\\u",    "\u00e9", "\u2030", "\u00a0", "\xC3", "\xFF", std::string(1, '\0'),
      "1979-05-27", "true",   "\r"};
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    for (unsigned count = random() % 40; count > 0; --count) text += pieces[random() % pieces.size()];
    ASSERT_EQ(fault_of_all(text), "") << "round " << round << "\n" << text;
  }
}

TEST(DescriptorRobustness, SurvivesSplicedLines) {
  std::mt19937 random(3);
  std::vector<std::string> lines;
  for (const std::string_view text : texts) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
      lines.emplace_back(text.substr(at, end - at));
      at = end;
    }
  }
  for (int round = 0; round < 5000; ++round) {
    std::string text;
    for (unsigned count = random() % 30; count > 0; --count) text += lines[random() % lines.size()];
    ASSERT_EQ(fault_of_all(text), "") << "round " << round << "\n" << text;
  }
}

TEST(DescriptorRobustness, SurvivesExtremes) {
  std::vector<std::string> extremes = {"",
                                       "\xEF\xBB\xBF",
                                       std::string(1 << 20, '['),
                                       std::string(1 << 20, '.'),
                                       std::string(1 << 20, '"'),
                                       "a=" + std::string(100000, '9'),
                                       "a=\"" + std::string(1 << 19, 'x') + "\"",
                                       std::string(1000, '\0')};
  std::string deep_headers;
  for (int i = 0; i < 100000; ++i) deep_headers += "[a.b]\n";
  extremes.push_back(deep_headers);
  for (const std::string& text : extremes) EXPECT_EQ(fault_of_all(text), "") << text.substr(0, 20);
}

TEST(DescriptorRobustness, TheCheckSeesAFault) {
  auto technique = parse_technique(examples::technique, "f.toml");
  ASSERT_TRUE(technique);
  EXPECT_EQ(fault_of(technique, "f.toml"), "");
  technique->parameters[0].value = 1e9;
  EXPECT_NE(fault_of(technique, "f.toml"), "");
  const Result<TechniqueDescriptor> lost = fail(ErrorCode::descriptor, "describe.type", "lost", "f.toml");
  EXPECT_EQ(fault_of(lost, "f.toml"), "the error has no place");
}

TEST(RegistryRobustness, SurvivesRandomBytesInATree) {
  std::mt19937 random(4);
  for (int round = 0; round < 3000; ++round) {
    SourceTree tree = examples::tree();
    auto source = tree.begin();
    std::advance(source, static_cast<std::ptrdiff_t>(random() % tree.size()));
    if (!source->second.empty()) source->second[random() % source->second.size()] = static_cast<char>(random());
    if (random() % 8 == 0) tree.erase(source);
    const auto registry = load_registry(std::move(tree));
    if (registry) continue;
    ASSERT_GE(registry.error().line, 1) << format(registry.error());
    ASSERT_GE(registry.error().column, 1) << format(registry.error());
    ASSERT_FALSE(registry.error().file.empty());
  }
}

}  // namespace
}  // namespace relievo
