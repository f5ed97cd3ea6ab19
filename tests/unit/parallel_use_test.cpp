/// For the thread sanitizer: one process compiles, permutes with a shared cache, reads and replaces an archive, and
/// reloads programs whose files are edited, all at once. What comes out is what each alone makes.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "relievo/hot_reload.hpp"
#include "relievo/permute.hpp"
#include "relievo/program_cache.hpp"
#include "relievo/trace.hpp"
#include "support/archive_walk.hpp"
#include "support/caches.hpp"
#include "support/edited_technique.hpp"
#include "support/files.hpp"

namespace relievo {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::array<Target, 3> kTargets{{{Language::glsl, 450}, {Language::essl, 300}, {Language::msl, 22}}};
constexpr int kEdits = 6;
constexpr auto kPatience = 120s;  // the sanitizer, on a busy machine

constexpr const char* kManifest = R"(schema = 1
name = "shared"
targets = ["spirv-1.0", "glsl-450"]
[axes]
technique = ["parallax", "bump"]
address = ["repeat", "clamp"]
)";

Permutation permutation_of(const std::string& technique, AddressMode address = AddressMode::repeat) {
  Permutation permutation;
  permutation.stage = "surface";
  permutation.address = address;
  permutation.roles["view"] = technique;
  return permutation;
}

/// Threads that repeat their work, at least once, until all are told to stop; each names what went wrong first.
class Crowd {
 public:
  ~Crowd() { stop(); }
  /// `work` answers with a fault, or nothing.
  void repeat(const std::string& name, std::function<std::string()> work) {
    threads_.emplace_back([this, name, work = std::move(work)] {
      do {
        std::string fault = work();
        const std::scoped_lock lock(mutex_);
        ++rounds_[name];
        if (!fault.empty()) faults_.emplace(name, std::move(fault));
      } while (!stopping_);
    });
  }
  void stop() {
    stopping_ = true;
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }
  const std::map<std::string, std::string>& faults() const { return faults_; }
  const std::map<std::string, int>& rounds() const { return rounds_; }

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> faults_;
  std::map<std::string, int> rounds_;
  std::atomic<bool> stopping_ = false;
  std::vector<std::thread> threads_;
};

TEST(Crowd, AFaultIsKeptWithTheNameOfItsThread) {
  Crowd crowd;
  std::atomic<int> round = 0;
  crowd.repeat("good", [] { return ""; });
  crowd.repeat("bad", [&] { return ++round == 1 ? "first" : "later"; });
  while (round < 2) std::this_thread::yield();
  crowd.stop();
  EXPECT_EQ(crowd.faults(), (std::map<std::string, std::string>{{"bad", "first"}}));
  EXPECT_GE(crowd.rounds().at("good"), 1);
}

class ParallelUse : public ::testing::Test {
 protected:
  ParallelUse() {
    fs::create_directories(folder_ / "user/edited");
    folder_.write("user/edited/technique.toml", test::descriptor("edited"));
    folder_.write("user/edited/edited.glsl", test::module("edited"));
    write_part("0.5");
    CacheOptions options;
    options.folder = folder_ / "cache";
    options.max_bytes = 1 << 20;  // so that entries are evicted meanwhile
    options.log = [this](std::string_view) { ++logged_; };
    cache_ = *open_cache(options);
  }

  void write_part(const std::string& value) { folder_.write("user/edited/part.glsl", test::part("edited", value)); }

  std::string compile_once(AddressMode address) const {
    const auto composed = compose(registry_, permutation_of("relief", address));
    if (!composed) return format(composed.error());
    const auto compiled = compile(*composed, kTargets);
    if (!compiled) return format(compiled.error());
    std::string all = compiled->reflection;
    for (const CompiledShader& shader : compiled->shaders) {
      for (const auto& [target, text] : shader.text) all += text;
    }
    return all;
  }

  /// The archive's bytes, or an error.
  std::string permute_once(const fs::path& archive, unsigned threads) const {
    PermuteOptions options;
    options.threads = threads;
    options.cache = cache_.get();
    const auto summary = permute(registry_, manifest_, plan_, archive, options);
    if (!summary) return format(summary.error());
    if (!summary->errors.empty()) return format(summary->errors.front().error);
    return test::TemporaryFolder::read(archive);
  }

  std::string prepare_once() {
    use_program_cache(cache_);
    const auto prepared = prepare(registry_, permutation_of("bump"), "glsl-450");
    use_program_cache(nullptr);
    return prepared ? "" : format(prepared.error());
  }

  std::string use_cache_folder() {
    const unsigned number = ++stored_ % 7;
    const std::size_t size = 1000 * (number + 1);
    cache_->store(test::numbered_key(number), test::numbered_payload(number, size));
    for (unsigned other = 0; other < 7; ++other) test::judge(answers_, *cache_, other, 1000 * (other + 1));
    if (answers_.wrong > 0) return "a payload that nobody stored under its key";
    cache_->counts();
    const auto contents = stored_ % 5 == 0 ? clear_cache(folder_ / "cache") : verify_cache(folder_ / "cache");
    return contents ? "" : format(contents.error());
  }

  /// The archive that others replace: opened anew, or `shared` of all readers.
  std::string read_archive(const Archive& shared) const {
    if (std::string fault = test::contradiction_of(shared); !fault.empty()) return fault;
    const auto archive = Archive::open(folder_ / "shared.rla");
    if (!archive) return format(archive.error());
    if (const Status status = archive->verify(); !status) return format(status.error());
    return archive->size() == plan_.permutations.size() ? "" : "an archive of another size";
  }

  void start_reloader() {
    auto reloader = HotReloader::create({{folder_ / "user"}, 1ms, 1ms, 2}, [this](const HotReloadEvent& event) {
      if (calls_.fetch_add(1) != 0) overlapped_ = true;
      if (event.error) ++errors_;
      if (event.state && !event.programs.empty()) reloader_->current(event.programs.front());
      --calls_;
    });
    ASSERT_TRUE(reloader) << format(reloader.error());
    reloader_ = *std::move(reloader);
  }

  std::string use_reloader() {
    HotProgram program{permutation_of("edited", AddressMode::clamp), {kTargets[0]}, {}};
    program.options.optimize = false;
    const HotProgramId id = reloader_->add(std::move(program));
    reloader_->poll();
    const bool is_there = reloader_->registry()->techniques.contains("edited");
    const HotReloadCounts counts = reloader_->counts();
    reloader_->remove(id);
    if (reloader_->current(id)) return "a program that was removed is there";
    return is_there && counts.compiled <= counts.composed ? "" : "a registry or count that cannot be";
  }

  static bool waits_for(const std::function<bool()>& condition) {
    const auto begin = std::chrono::steady_clock::now();
    while (!condition()) {
      if (std::chrono::steady_clock::now() - begin > kPatience) return false;
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }

  /// Edits until every one was told; every third does not compile.
  void edit_until_told(HotProgramId id) {
    for (int i = 1; i <= kEdits; ++i) {
      const int errors = errors_;
      const std::string value = "0." + std::string(static_cast<std::size_t>(i), '1');
      write_part(i % 3 == 0 ? value + " +" : value);
      ASSERT_TRUE(waits_for([&] {
        if (i % 3 == 0) return errors_ > errors;
        const auto state = reloader_->current(id);
        return state && state->composed.shaders.back().text.find("return " + value + ";") != std::string::npos;
      })) << "edit "
          << i;
    }
  }

  test::TemporaryFolder folder_;
  const Registry registry_ = *load_registry();
  const Manifest manifest_ = *parse_manifest(kManifest, "relievo.toml");
  const PermutationPlan plan_ = *plan_permutations(registry_, manifest_);
  std::shared_ptr<Cache> cache_;
  std::atomic<int> logged_ = 0, calls_ = 0, errors_ = 0;
  unsigned stored_ = 0;
  test::Answers answers_;  ///< to one thread
  std::atomic<bool> overlapped_ = false;
  std::unique_ptr<HotReloader> reloader_;
};

TEST_F(ParallelUse, CompilingPermutingReadingAndReloadingAtOnceMakeWhatEachMakesAlone) {
  const std::string repeated = compile_once(AddressMode::repeat), clamped = compile_once(AddressMode::clamp);
  const std::string archived = permute_once(folder_ / "shared.rla", 1);
  ASSERT_TRUE(archived.starts_with("RELIEVO")) << archived.substr(0, 200);
  const auto shared = Archive::open(folder_ / "shared.rla");
  ASSERT_TRUE(shared) << format(shared.error());
  start_reloader();
  HotProgram program{permutation_of("edited"), {kTargets[0]}, {}};
  program.options.optimize = false;
  const HotProgramId id = reloader_->add(program);

  Crowd crowd;
  const auto differs = [](const std::string& made, const std::string& alone) {
    return made == alone ? std::string() : "differs: " + made.substr(0, 200);
  };
  crowd.repeat("compile", [&] { return differs(compile_once(AddressMode::repeat), repeated); });
  crowd.repeat("compile other", [&] { return differs(compile_once(AddressMode::clamp), clamped); });
  crowd.repeat("permute", [&] { return differs(permute_once(folder_ / "shared.rla", 1), archived); });
  crowd.repeat("permute beside", [&] { return differs(permute_once(folder_ / "other.rla", 2), archived); });
  crowd.repeat("read", [&] { return read_archive(*shared); });
  crowd.repeat("read too", [&] { return read_archive(*shared); });
  crowd.repeat("cache", [&] { return use_cache_folder(); });
  crowd.repeat("jobs", [&] { return prepare_once(); });
  crowd.repeat("reload", [&] { return use_reloader(); });
  edit_until_told(id);
  crowd.stop();

  for (const auto& [name, fault] : crowd.faults()) ADD_FAILURE() << name << ": " << fault;
  EXPECT_EQ(crowd.rounds().size(), 9u);
  EXPECT_FALSE(overlapped_) << "two callbacks at once";
  EXPECT_GT(answers_.right, 0);
  EXPECT_GE(errors_, kEdits / 3);
  reloader_.reset();
}

}  // namespace
}  // namespace relievo
