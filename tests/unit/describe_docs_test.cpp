#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "support/files.hpp"
#include "unit/describe_examples.hpp"

namespace relievo {
namespace {

const std::string docs = test::TemporaryFolder::read(RELIEVO_SOURCE_DIR "/docs/descriptors.md");

/// The first ```toml block after the heading.
std::string example(const std::string& heading) {
  const std::size_t section = docs.find("\n## " + heading + "\n");
  const std::size_t fence = docs.find("```toml\n", section);
  if (section == docs.npos || fence == docs.npos) return {};
  return docs.substr(fence + 8, docs.find("```\n", fence + 8) - fence - 8);
}

TEST(DescriptorDocs, ShowATechniqueThatParses) {
  const auto technique = parse_technique(example("technique.toml"), "techniques/relief/technique.toml");
  ASSERT_TRUE(technique) << format(technique.error());
  EXPECT_EQ(technique->parameters.size(), 3u);
}

TEST(DescriptorDocs, ShowAMapThatParses) {
  const auto map = parse_map(example("map.toml"), "shaders/maps/normal/map.toml");
  ASSERT_TRUE(map) << format(map.error());
  EXPECT_EQ(map->parameters.size(), 1u);
}

TEST(DescriptorDocs, ShowAStageThatParses) {
  const auto stage = parse_stage(example("stage.toml"), "shaders/stages/prism/stage.toml");
  ASSERT_TRUE(stage) << format(stage.error());
  EXPECT_EQ(stage->shaders.size(), 3u);
}

TEST(DescriptorDocs, NameEveryFeature) {
  for (const std::string& feature : known_features()) {
    EXPECT_NE(docs.find("`" + feature + "`"), std::string::npos) << feature;
  }
}

/// Every error id of the text that follows `mark`: a quote in C++, a backtick in the docs.
std::set<std::string> ids_of(const std::string& text, char mark) {
  std::set<std::string> ids;
  const std::string start = mark + std::string("describe.");
  for (std::size_t at = text.find(start); at != text.npos; at = text.find(start, at + 1)) {
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", at + start.size());
    ids.insert(text.substr(at + 1, end - at - 1));
  }
  return ids;
}

TEST(DescriptorDocs, NameEveryErrorOfTheSources) {
  const std::set<std::string> documented = ids_of(docs, '`');
  std::set<std::string> raised;
  for (const auto& entry : std::filesystem::directory_iterator(RELIEVO_SOURCE_DIR "/sdk/src/describe")) {
    raised.merge(ids_of(test::TemporaryFolder::read(entry.path()), '"'));
  }
  raised.erase("describe.unknown-");  // ends in the kind, which a test of the look-ups sees
  EXPECT_GE(raised.size(), 10u);
  for (const std::string& id : raised) EXPECT_TRUE(documented.contains(id)) << id;
  EXPECT_FALSE(documented.contains("describe.nothing"));
}

}  // namespace
}  // namespace relievo
