#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/files.hpp"
#include "unit/describe_examples.hpp"

namespace relievo {
namespace {

namespace fs = std::filesystem;
using examples::with;

/// A technique that needs no map, so that it stands beside whatever is embedded.
constexpr std::string_view template_technique = R"(schema = 1
name = "template_technique"
title = "Template"
class = "unsafe"
first_hit = "never"
module = "template_technique.glsl"
)";

/// Each test has a folder of its own, removed at the end.
class LoadRegistryFromFolder : public testing::Test {
 protected:
  void write(const std::string& path, std::string_view text) {
    fs::create_directories((root / path).parent_path());
    std::ofstream(root / path, std::ios::binary) << text;
  }
  void write_template(const std::string& folder) {
    write(folder + "/technique.toml", template_technique);
    write(folder + "/template_technique.glsl", "// trace\n");
  }
  std::string on_disk(const std::string& path) { return (root / path).generic_string(); }

  const test::TemporaryFolder temporary;
  const fs::path root = temporary.path();
};

TEST_F(LoadRegistryFromFolder, AddsATechniqueAndNothingElse) {
  write_template("template_technique");
  const auto before = load_registry();
  const auto after = load_registry({root});
  ASSERT_TRUE(before) << format(before.error());
  ASSERT_TRUE(after) << format(after.error());
  EXPECT_EQ(after->techniques.size(), before->techniques.size() + 1);
  EXPECT_EQ(after->maps.size(), before->maps.size());
  EXPECT_EQ(after->stages.size(), before->stages.size());
  EXPECT_EQ(after->sources.size(), before->sources.size() + 2);
  const TechniqueDescriptor& technique = after->techniques.at("template_technique");
  EXPECT_EQ(technique.module, "techniques/template_technique/template_technique.glsl");
  EXPECT_EQ(after->sources.at(technique.module), "// trace\n");
  EXPECT_EQ(after->origins.at(technique.module), on_disk("template_technique/template_technique.glsl"));
}

TEST_F(LoadRegistryFromFolder, TakesTheFolderItself) {
  write_template("template_technique");
  for (const fs::path& folder :
       {root / "template_technique", root / "template_technique" / "", root / "template_technique" / "."}) {
    const auto registry = load_registry({folder});
    ASSERT_TRUE(registry) << folder << format(registry.error());
    EXPECT_TRUE(registry->techniques.contains("template_technique"));
  }
}

TEST_F(LoadRegistryFromFolder, PutsMapsAndStagesBelowShaders) {
  write("first_map/map.toml",
        with(with(with(examples::provided_map, "height", "first_map"), "relievo_height_map", "first"),
             "{set = 1, binding = 0}", "{set = 3, binding = 90}"));
  write("first_stage/stage.toml",
        "schema = 1\nname = \"first_stage\"\ntitle = \"S\"\n[[shader]]\nstage = \"compute\"\nmodule = \"s.glsl\"\n");
  write("first_stage/s.glsl", "");
  const auto registry = load_registry({root});
  ASSERT_TRUE(registry) << format(registry.error());
  EXPECT_EQ(registry->maps.at("first_map").file, "shaders/maps/first_map/map.toml");
  EXPECT_EQ(registry->stages.at("first_stage").shaders.at(0).module, "shaders/stages/first_stage/s.glsl");
}

TEST_F(LoadRegistryFromFolder, FindsTheMapsOfATechnique) {
  write_template("template_technique");
  write("template_technique/maps/own_map/map.toml",
        with(with(with(examples::provided_map, "height", "own_map"), "relievo_height_map", "own"),
             "{set = 1, binding = 0}", "{set = 3, binding = 91}"));
  const auto registry = load_registry({root});
  ASSERT_TRUE(registry) << format(registry.error());
  EXPECT_EQ(registry->maps.at("own_map").file, "techniques/template_technique/maps/own_map/map.toml");
}

TEST_F(LoadRegistryFromFolder, ReadsOnlySources) {
  write_template("template_technique");
  write("template_technique/README.md", "text");
  write("template_technique/.hidden.glsl", "text");
  write("template_technique/.git/x.glsl", "text");
  write("notes/readme.toml", "not a descriptor");
  const auto registry = load_registry({root});
  ASSERT_TRUE(registry) << format(registry.error());
  EXPECT_EQ(registry->origins.size(), 2u);
}

TEST_F(LoadRegistryFromFolder, NamesTheFileOnDisk) {
  write_template("template_technique");
  write("template_technique/technique.toml", with(template_technique, "title", "tittle"));
  const auto parsed = load_registry({root});
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().file, on_disk("template_technique/technique.toml"));
  examples::expect_error(parsed.error(), "describe.unknown-key", 3, 1, "title");
  write("template_technique/technique.toml", with(template_technique, "template_technique.glsl", "none.glsl"));
  const auto checked = load_registry({root});
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().file, on_disk("template_technique/technique.toml"));
  EXPECT_EQ(checked.error().id, "describe.missing-file");
}

TEST_F(LoadRegistryFromFolder, RejectsANameTwice) {
  write_template("a/template_technique");
  write_template("b/template_technique");
  const auto registry = load_registry({root / "a", root / "b"});
  ASSERT_FALSE(registry);
  EXPECT_EQ(registry.error().file, on_disk("b/template_technique/technique.toml"));
  examples::expect_error(registry.error(), "describe.duplicate", 2, 8, on_disk("a/template_technique"));
}

TEST_F(LoadRegistryFromFolder, ReportsAFolderThatCannotBeRead) {
  const auto missing = load_registry({root / "none"});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::io);
  EXPECT_EQ(missing.error().id, "describe.unreadable");
  EXPECT_EQ(missing.error().file, on_disk("none"));
  write("file", "text");
  const auto file = load_registry({root / "file"});
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().message.find("it is not a folder"), std::string::npos) << file.error().message;
}

TEST_F(LoadRegistryFromFolder, AcceptsAnEmptyFolder) {
  EXPECT_TRUE(load_registry({root}));
}

TEST_F(LoadRegistryFromFolder, RejectsAFileOverAMebibyte) {
  write_template("template_technique");
  write("template_technique/template_technique.glsl", std::string((1 << 20), ' '));
  EXPECT_TRUE(load_registry({root}));
  write("template_technique/template_technique.glsl", std::string((1 << 20) + 1, ' '));
  const auto registry = load_registry({root});
  ASSERT_FALSE(registry);
  EXPECT_EQ(registry.error().id, "describe.unreadable");
  EXPECT_EQ(registry.error().file, on_disk("template_technique/template_technique.glsl"));
}

TEST_F(LoadRegistryFromFolder, DoesNotFollowLinksOutOfTheFolder) {
  write_template("inside/template_technique");
  write("outside/secret.glsl", "secret");
  write_template("outside/linked");
  fs::create_symlink(root / "outside/secret.glsl", root / "inside/template_technique/secret.glsl");
  fs::create_directory_symlink(root / "outside", root / "inside/template_technique/more");
  fs::create_directory_symlink(root / "outside/linked", root / "inside/linked");
  const auto registry = load_registry({root / "inside"});
  ASSERT_TRUE(registry) << format(registry.error());
  EXPECT_EQ(registry->origins.size(), 2u);
}

TEST_F(LoadRegistryFromFolder, FollowsLinksThatStayInside) {
  write_template("template_technique");
  fs::create_symlink("template_technique.glsl", root / "template_technique/alias.glsl");
  fs::create_directory_symlink(root, root / "template_technique/loop");
  const auto registry = load_registry({root});
  ASSERT_TRUE(registry) << format(registry.error());
  EXPECT_TRUE(registry->sources.contains("techniques/template_technique/alias.glsl"));
  EXPECT_EQ(registry->origins.size(), 3u);
}

}  // namespace
}  // namespace relievo
