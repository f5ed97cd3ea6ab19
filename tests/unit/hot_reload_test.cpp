/// Programs that follow their sources: what an edit reaches, what it does not, and what a broken one leaves alone.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "permute/hot_reload/reach.hpp"
#include "permute/hot_reload/watch.hpp"
#include "relievo/hot_reload.hpp"
#include "support/edited_technique.hpp"
#include "support/files.hpp"

namespace relievo {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

using test::descriptor;
using test::module;
using test::part;

constexpr Target kGlsl{Language::glsl, 450};

/// A folder with techniques to edit, a reloader without a thread, and what it told.
class HotReload : public ::testing::Test {
 protected:
  HotReload() {
    write_technique("one");
    write_technique("two");
  }

  void write_technique(const std::string& name) {
    fs::create_directories(folder_ / ("user/" + name));
    edit(name + "/technique.toml", descriptor(name));
    edit(name + "/" + name + ".glsl", module(name));
    edit(name + "/part.glsl", part(name, "0.5"));
  }

  /// Every edit gets a time of its own, as if the user took seconds: tests are quicker than clocks of files.
  void edit(const std::string& name, const std::string& text) {
    folder_.write("user/" + name, text);
    set_time(name);
  }
  void set_time(const std::string& name) {
    seconds_ += 1s;
    fs::last_write_time(folder_ / ("user/" + name), fs::file_time_type::clock::now() - 1h + seconds_);
  }

  void start(std::chrono::milliseconds interval = 0ms, std::chrono::milliseconds settle = 0ms, unsigned threads = 1) {
    HotReloadOptions options{{folder_ / "user"}, interval, settle, threads};
    auto reloader = HotReloader::create(options, [this](const HotReloadEvent& event) { tell(event); });
    ASSERT_TRUE(reloader) << format(reloader.error());
    reloader_ = *std::move(reloader);
  }

  void tell(const HotReloadEvent& event) {
    const std::scoped_lock lock(mutex_);
    events_.push_back(event);
  }
  std::vector<HotReloadEvent> take_events() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(events_, {});
  }

  HotProgramId add(const std::string& technique, const std::string& stage = "surface",
                   AddressMode address = AddressMode::repeat) {
    HotProgram program;
    program.permutation.stage = stage;
    program.permutation.address = address;
    program.permutation.roles["view"] = technique;
    program.targets = {kGlsl};
    program.options.optimize = false;
    return reloader_->add(program);
  }

  /// The programs that were told to be new, one an event, in this poll.
  std::set<HotProgramId> reloaded() {
    reloader_->poll();
    std::set<HotProgramId> ids;
    for (const HotReloadEvent& event : take_events()) {
      EXPECT_FALSE(event.error) << format(*event.error);
      EXPECT_EQ(event.programs.size(), event.state ? 1u : 0u);
      ids.insert(event.programs.begin(), event.programs.end());
    }
    return ids;
  }
  std::uint64_t compiled() const { return reloader_->counts().compiled; }
  std::string text_of(HotProgramId id) const {
    const auto state = reloader_->current(id);
    return state ? state->composed.shaders.back().text : "";
  }
  bool waits_for(const std::function<bool()>& condition) const {
    for (int i = 0; i < 2000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }

  test::TemporaryFolder folder_;
  std::chrono::seconds seconds_{0};
  std::mutex mutex_;
  std::vector<HotReloadEvent> events_;
  std::unique_ptr<HotReloader> reloader_;
};

TEST_F(HotReload, AnEditReachesTheProgramsThatIncludeTheFileAndNoOthers) {
  start();
  const HotProgramId one = add("one"), two = add("two"), clamped = add("one", "surface", AddressMode::clamp);
  const HotProgramId ours = add("parallax");
  EXPECT_EQ(reloaded(), (std::set{one, two, clamped, ours}));
  ASSERT_EQ(compiled(), 4u);
  EXPECT_EQ(reloaded(), std::set<HotProgramId>{});
  const auto before = reloader_->current(two);
  edit("one/part.glsl", part("one", "0.125"));
  EXPECT_EQ(reloaded(), (std::set{one, clamped}));
  EXPECT_EQ(compiled(), 6u);
  EXPECT_NE(text_of(one).find("0.125"), std::string::npos);
  EXPECT_NE(reloader_->current(one)->compiled.shaders.back().text.at("glsl-450").find("0.125"), std::string::npos);
  EXPECT_EQ(reloader_->current(two), before);
  edit("two/two.glsl", "// commented\n" + module("two"));
  EXPECT_EQ(reloaded(), std::set{two});
  EXPECT_EQ(compiled(), 7u);
}

TEST_F(HotReload, ATouchedFileRecompilesNothing) {
  start();
  add("one");
  reloaded();
  const HotReloadCounts before = reloader_->counts();
  set_time("one/part.glsl");
  EXPECT_EQ(reloaded(), std::set<HotProgramId>{});
  const HotReloadCounts after = reloader_->counts();
  EXPECT_EQ(after.loads, before.loads + 1);  // the contents were looked at
  EXPECT_EQ(after.composed, before.composed);
  EXPECT_EQ(after.compiled, before.compiled);
}

TEST_F(HotReload, AFileThatIsIncludedByNobodyRecompilesNothing) {
  start();
  add("one");
  reloaded();
  edit("one/notes.glsl", "not GLSL at all\n");
  EXPECT_EQ(reloaded(), std::set<HotProgramId>{});
  edit("one/notes.glsl", "nor this\n");
  EXPECT_EQ(reloaded(), std::set<HotProgramId>{});
  EXPECT_EQ(compiled(), 1u);
}

TEST_F(HotReload, ABrokenEditKeepsTheOldProgramsAndIsToldOnce) {
  start();
  const HotProgramId one = add("one"), clamped = add("one", "surface", AddressMode::clamp), two = add("two");
  reloaded();
  const auto before = reloader_->current(one);
  edit("one/part.glsl", part("one", "nothing"));
  EXPECT_EQ(reloader_->poll(), 0u);
  std::vector<HotReloadEvent> events = take_events();
  ASSERT_EQ(events.size(), 1u);  // the same error in two programs
  ASSERT_TRUE(events[0].error);
  EXPECT_EQ(events[0].programs, (std::vector{one, clamped}));
  EXPECT_EQ(events[0].error->line, 2);
  EXPECT_EQ(events[0].error->file, (folder_ / "user/one/part.glsl").generic_string());
  EXPECT_EQ(events[0].error->id, "compile.glsl");
  EXPECT_EQ(reloader_->current(one), before);

  edit("one/part.glsl", part("one", "nothing") + "// the same error\n");
  reloader_->poll();
  EXPECT_TRUE(take_events().empty());
  EXPECT_EQ(compiled(), 7u);
  edit("one/part.glsl", "\n" + part("one", "nothing"));
  reloader_->poll();
  events = take_events();
  ASSERT_EQ(events.size(), 1u);  // another line, another error
  EXPECT_EQ(events[0].error->line, 3);

  edit("one/part.glsl", part("one", "0.75"));
  EXPECT_EQ(reloaded(), (std::set{one, clamped}));
  EXPECT_NE(reloader_->current(one), before);
  EXPECT_FALSE(text_of(two).empty());
}

TEST_F(HotReload, ABrokenEditThatIsTakenBackIsToldAndCompilesNothing) {
  start();
  const HotProgramId one = add("one");
  reloaded();
  const auto before = reloader_->current(one);
  edit("one/part.glsl", part("one", "nothing"));
  reloader_->poll();
  ASSERT_EQ(take_events().size(), 1u);
  const std::uint64_t count = compiled();
  edit("one/part.glsl", part("one", "0.5"));
  reloader_->poll();
  const std::vector<HotReloadEvent> events = take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_FALSE(events[0].error);
  EXPECT_EQ(events[0].programs, std::vector{one});
  EXPECT_EQ(events[0].state, before);
  EXPECT_EQ(compiled(), count);
}

TEST_F(HotReload, AFileThatIsMissingAndThenWrittenIsFound) {
  start();
  const HotProgramId one = add("one"), two = add("two");
  reloaded();
  edit("one/part.glsl", "#include \"more.glsl\"\n" + part("one", "one_more()"));
  reloader_->poll();
  const std::vector<HotReloadEvent> events = take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].error->id, "compose.missing-include");
  EXPECT_EQ(events[0].error->file, (folder_ / "user/one/part.glsl").generic_string());
  EXPECT_EQ(events[0].error->line, 1);
  edit("one/more.glsl", "float one_more() {\n  return 0.375;\n}\n");
  EXPECT_EQ(reloaded(), std::set{one});
  EXPECT_NE(text_of(one).find("0.375"), std::string::npos);
  edit("one/more.glsl", "float one_more() {\n  return 0.0625;\n}\n");
  EXPECT_EQ(reloaded(), std::set{one});
  EXPECT_EQ(text_of(two).find("0.0625"), std::string::npos);
}

TEST_F(HotReload, ADescriptorsEditReachesItsPrograms) {
  start();
  const HotProgramId one = add("one"), two = add("two");
  reloaded();
  edit("one/technique.toml", descriptor("one", 0.5));
  EXPECT_EQ(reloaded(), std::set{one});
  EXPECT_EQ(compiled(), 3u);
  double bias = 0;
  for (const ParameterSlot& slot : reloader_->current(one)->composed.parameters) {
    if (slot.name == "one.bias") bias = slot.value;
  }
  EXPECT_EQ(bias, 0.5);
  EXPECT_NE(reloader_->current(two), nullptr);
}

TEST_F(HotReload, ABrokenDescriptorIsToldOnceOfNoProgramAndThenMended) {
  start();
  const HotProgramId one = add("one");
  reloaded();
  edit("one/technique.toml", descriptor("one") + "nonsense = 1\n");
  reloader_->poll();
  std::vector<HotReloadEvent> events = take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_TRUE(events[0].programs.empty());
  EXPECT_EQ(events[0].error->id, "describe.unknown-key");
  EXPECT_EQ(events[0].error->file, (folder_ / "user/one/technique.toml").generic_string());
  edit("one/technique.toml", descriptor("one") + "nonsense = 1\n# still\n");
  reloader_->poll();
  EXPECT_TRUE(take_events().empty());
  EXPECT_NE(reloader_->current(one), nullptr);
  edit("one/technique.toml", descriptor("one"));
  reloader_->poll();
  events = take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_FALSE(events[0].error || events[0].state || !events[0].programs.empty());
  EXPECT_EQ(compiled(), 1u);
}

TEST_F(HotReload, AFolderMayVanishAndComeBack) {
  start();
  const HotProgramId one = add("one");
  reloaded();
  const auto before = reloader_->current(one);
  fs::rename(folder_ / "user", folder_ / "elsewhere");
  for (int i = 0; i < 3; ++i) reloader_->poll();
  std::vector<HotReloadEvent> events = take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].error->id, "describe.unreadable");
  EXPECT_EQ(reloader_->current(one), before);
  fs::rename(folder_ / "elsewhere", folder_ / "user");
  reloader_->poll();
  events = take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_FALSE(events[0].error);
  EXPECT_EQ(compiled(), 1u);
  edit("one/part.glsl", part("one", "0.0"));
  EXPECT_EQ(reloaded(), std::set{one});
}

TEST_F(HotReload, ATechniqueThatIsAddedLaterIsFound) {
  start();
  const HotProgramId three = add("three");
  reloader_->poll();
  ASSERT_EQ(take_events().at(0).error->id, "describe.unknown-technique");
  EXPECT_EQ(reloader_->current(three), nullptr);
  write_technique("three");
  EXPECT_EQ(reloaded(), std::set{three});
  fs::remove_all(folder_ / "user/three");
  reloader_->poll();
  EXPECT_EQ(take_events().at(0).error->id, "describe.unknown-technique");
  EXPECT_NE(reloader_->current(three), nullptr);
}

TEST_F(HotReload, AFileThatIsBeingWrittenIsWaitedFor) {
  start(0ms, 400ms);
  const HotProgramId one = add("one");
  reloaded();
  const std::string text = part("one", "0.875");
  std::ofstream file(folder_ / "user/one/part.glsl", std::ios::trunc);
  for (const char c : text) {
    file << c << std::flush;
    std::this_thread::sleep_for(2ms);
    EXPECT_EQ(reloaded(), std::set<HotProgramId>{});
  }
  file.close();
  EXPECT_TRUE(waits_for([&] { return reloaded() == std::set{one}; }));
  EXPECT_EQ(compiled(), 2u);
}

TEST_F(HotReload, EditorsThatRenameAreFollowed) {
  start();
  const HotProgramId one = add("one");
  reloaded();
  fs::rename(folder_ / "user/one/part.glsl", folder_ / "user/one/part.glsl~");
  folder_.write("user/one/.part.glsl.swp", part("one", "0.3125"));
  fs::rename(folder_ / "user/one/.part.glsl.swp", folder_ / "user/one/part.glsl");
  EXPECT_EQ(reloaded(), std::set{one});
  EXPECT_NE(text_of(one).find("0.3125"), std::string::npos);
}

TEST_F(HotReload, AnEditWithTheSameSizeAndTimeIsSeenTwoSecondsLater) {
  start();
  const HotProgramId one = add("one");
  reloaded();
  const fs::path file = folder_ / "user/one/part.glsl";
  const auto now = fs::file_time_type::clock::now();
  folder_.write("user/one/part.glsl", part("one", "0.1"));
  fs::last_write_time(file, now);
  EXPECT_EQ(reloaded(), std::set{one});
  folder_.write("user/one/part.glsl", part("one", "0.2"));
  fs::last_write_time(file, now);
  EXPECT_TRUE(waits_for([&] { return reloaded() == std::set{one}; }));
  EXPECT_NE(text_of(one).find("0.2"), std::string::npos);
}

TEST_F(HotReload, TheCallbackMayCallBack) {
  HotProgramId second = 0;
  std::size_t polled = 99;
  HotReloadOptions options{{folder_ / "user"}, 0ms, 0ms, 1};
  auto reloader = HotReloader::create(options, [&](const HotReloadEvent& event) {
    tell(event);
    polled = reloader_->poll();
    if (second != 0) return;
    EXPECT_EQ(reloader_->current(event.programs.at(0)), event.state);
    second = add("two");
    reloader_->remove(event.programs.at(0));
    EXPECT_GT(reloader_->counts().looks, 0u);
  });
  ASSERT_TRUE(reloader);
  reloader_ = *std::move(reloader);
  const HotProgramId one = add("one");
  EXPECT_EQ(reloader_->poll(), 1u);
  EXPECT_EQ(polled, 0u);
  EXPECT_EQ(reloader_->current(one), nullptr);
  EXPECT_EQ(reloader_->poll(), 1u);
  EXPECT_NE(reloader_->current(second), nullptr);
  reloader_.reset();
}

TEST_F(HotReload, AThreadOfItsOwnFollowsManyFastEdits) {
  start(5ms, 300ms, 2);
  std::vector<HotProgramId> ids;
  for (int i = 0; i < 3; ++i) ids.push_back(add("one", "surface", static_cast<AddressMode>(i)));
  ASSERT_TRUE(waits_for([&] { return reloader_->counts().compiled == 3; }));
  for (int i = 0; i < 200; ++i) {
    // At once, as editors do: a file half written, and left so for longer than is waited for, would be an error.
    folder_.write("part.new", part("one", "0.5 + " + std::to_string(i) + ".0"));
    fs::rename(folder_ / "part.new", folder_ / "user/one/part.glsl");
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_TRUE(waits_for([&] {
    return std::all_of(ids.begin(), ids.end(),
                       [&](HotProgramId id) { return text_of(id).find("0.5 + 199.0") != std::string::npos; });
  }));
  for (const HotReloadEvent& event : take_events()) EXPECT_FALSE(event.error) << format(*event.error);
  EXPECT_LT(compiled(), 300u);  // 3 programs × 200 versions, were each compiled
}

/// For the thread sanitizer: everything at once.
TEST_F(HotReload, ManyThreadsMayUseItWhileOthersCompile) {
  start(1ms, 1ms, 2);
  std::atomic<bool> stop = false;
  std::vector<std::thread> threads;
  threads.emplace_back([&] {
    while (!stop) {
      const HotProgramId id = add("two");
      std::this_thread::sleep_for(2ms);
      reloader_->remove(id);
    }
  });
  threads.emplace_back([&] {
    while (!stop) {
      reloader_->poll();
      reloader_->counts();
      std::this_thread::sleep_for(1ms);
    }
  });
  threads.emplace_back([&] {
    const Result<Registry> registry = load_registry();
    Permutation permutation;
    permutation.stage = "surface";
    permutation.roles = {{"view", "relief"}};
    while (!stop) {
      const auto composed = compose(*registry, permutation);
      EXPECT_TRUE(composed && compile(*composed, {&kGlsl, 1}));
    }
  });
  const HotProgramId one = add("one");
  for (int i = 0; i < 20; ++i) {
    folder_.write("user/one/part.glsl", part("one", "0." + std::string(static_cast<std::size_t>(i + 1), '1')));
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_TRUE(waits_for([&] { return text_of(one).find("0." + std::string(20, '1')) != std::string::npos; }));
  stop = true;
  for (std::thread& thread : threads) thread.join();
}

TEST_F(HotReload, TheDestructorWaitsForWhatIsUnderWay) {
  const auto has_told = [&] {
    const std::scoped_lock lock(mutex_);
    return !events_.empty();
  };
  std::size_t told = 0;
  for (int i = 0; i < 5; ++i) {
    start(1ms, 1ms);
    for (int k = 0; k < 4; ++k) add("one");
    std::this_thread::sleep_for(std::chrono::milliseconds(3 * i));
    EXPECT_TRUE(i < 4 || waits_for(has_told)) << "else a slow machine is done before anything is told";
    reloader_.reset();
    told += take_events().size();
    std::this_thread::sleep_for(5ms);
    EXPECT_TRUE(take_events().empty()) << "after the destructor of round " << i;
  }
  EXPECT_GT(told, 0u);
}

TEST_F(HotReload, TheRegistryIsThatOfTheLastReadingWithoutAnError) {
  start();
  const auto before = reloader_->registry();
  edit("one/technique.toml", descriptor("one", 0.75));
  reloaded();
  const auto after = reloader_->registry();
  EXPECT_EQ(before->techniques.at("one").parameters.at(0).value, 0.25);
  EXPECT_EQ(after->techniques.at("one").parameters.at(0).value, 0.75);
  edit("one/technique.toml", "broken");
  reloader_->poll();
  EXPECT_EQ(reloader_->registry(), after);
}

TEST_F(HotReload, FoldersThatCannotBeReadAtFirstAreAnError) {
  const auto reloader = HotReloader::create({{folder_ / "nowhere"}, 0ms, 0ms, 1}, {});
  ASSERT_FALSE(reloader);
  EXPECT_EQ(reloader.error().id, "describe.unreadable");
}

/// The checks above rest on these two: a wrong answer of either is seen.
TEST(HotReloadReach, IsByTheFilesOfTheShaders) {
  ComposedProgram program;
  program.shaders = {{ShaderStage::fragment, "text", {"a.glsl", "b.glsl"}}};
  EXPECT_TRUE(reaches(changes_between({{"a.glsl", "1"}}, {{"a.glsl", "2"}}), program));
  EXPECT_FALSE(reaches(changes_between({{"c.glsl", "1"}}, {{"c.glsl", "2"}}), program));
  EXPECT_FALSE(reaches(changes_between({{"a.glsl", "1"}}, {{"a.glsl", "1"}}), program));
  EXPECT_TRUE(reaches(changes_between({}, {{"c.glsl", "1"}}), program));  // names may resolve differently now
  EXPECT_TRUE(reaches(changes_between({{"c.toml", "1"}}, {{"c.toml", "2"}}), program));
}

TEST(HotReloadReach, FingerprintsTellTextsAndValuesApart) {
  ComposedProgram program;
  program.shaders = {{ShaderStage::fragment, "text", {}}};
  program.parameters.push_back({"a.b", false, BindingTime::uniform, 1});
  const CacheKey key = fingerprint(program);
  EXPECT_EQ(fingerprint(program), key);
  ComposedProgram other = program;
  other.shaders[0].text = "texts";
  EXPECT_NE(fingerprint(other), key);
  other = program;
  other.parameters[0].value = 2;
  EXPECT_NE(fingerprint(other), key);
  other = program;
  other.parameters[0].default_value = 2;
  EXPECT_NE(fingerprint(other), key);
}

}  // namespace
}  // namespace relievo
