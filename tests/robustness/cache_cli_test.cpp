/// `relievo cache` on sound, damaged and impossible folders.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/caches.hpp"
#include "support/child.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class CacheCli : public ::testing::Test {
 protected:
  void SetUp() override {
    LoggedCache cache(folder_ / "cache");
    for (std::uint64_t i = 0; i < 4; ++i) cache->store(numbered_key(i), numbered_payload(i, 1000));
  }
  std::string folder() const { return folder_ / "cache"; }
  nlohmann::json json_of(const std::string& operation) const {
    const ChildResult result = run_relievo({"cache", operation, "--json", "--cache", folder()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }
  nlohmann::json contents(int entries, int broken, int unfinished) const {
    return {{"folder", folder()}, {"entries", entries}, {"bytes", entries * 1056},
            {"broken", broken},   {"unreadable", 0},    {"unfinished", unfinished}};
  }
  TemporaryFolder folder_;
};

TEST_F(CacheCli, CountsVerifiesAndClears) {
  const fs::path damaged = entry_file(folder(), numbered_key(2));
  fs::resize_file(damaged, 1000);
  fs::resize_file(damaged, 1056);
  std::ofstream((damaged.parent_path() / damaged.stem()).string() + ".999999999-1.tmp") << "left";
  EXPECT_EQ(json_of("stats"), contents(4, 0, 1));
  EXPECT_EQ(json_of("verify"), contents(3, 1, 1));
  EXPECT_EQ(json_of("verify"), contents(3, 0, 1));
  EXPECT_EQ(json_of("clear"), contents(3, 0, 1));
  EXPECT_EQ(json_of("stats"), contents(0, 0, 0));
}

TEST_F(CacheCli, FindsTheFolderInTheEnvironment) {
  const ChildResult result = run_relievo({"cache", "stats"}, {{"RELIEVO_CACHE_DIR", folder()}});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, folder() + ": 4 entries, 0.0 MB\n");
}

TEST_F(CacheCli, SaysWhatIsWrong) {
  const std::string file = folder_.write("file", "");
  const auto error_of = [](const std::vector<std::string>& arguments) {
    const ChildResult result =
        run_relievo(arguments, {{"RELIEVO_CACHE_DIR", ""}, {"XDG_CACHE_HOME", ""}, {"HOME", ""}});
    EXPECT_EQ(result.exit_code, 1);
    return result.err + result.out;
  };
  EXPECT_THAT(error_of({"cache", "clear", "--cache", file}), HasSubstr("cache.folder"));
  EXPECT_THAT(error_of({"cache", "stats", "--cache", "redis://host"}), HasSubstr("expected a folder"));
  EXPECT_THAT(error_of({"cache", "verify"}), HasSubstr("no cache folder is known"));
  EXPECT_THAT(error_of({"cache"}), HasSubstr("subcommand"));
}

}  // namespace
}  // namespace relievo::test
