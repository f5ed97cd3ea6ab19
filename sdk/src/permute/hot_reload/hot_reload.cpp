#include "relievo/hot_reload.hpp"

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <new>
#include <thread>

#include "permute/hot_reload/recompile.hpp"
#include "permute/hot_reload/watch.hpp"

namespace relievo {

/// Two locks: `polling_` for the one thread that looks, compiles and calls back, and `mutex_`, held shortly, for what
/// others may ask meanwhile. The callback runs with neither but the first, which nobody waits for.
class HotReloader::State {
 public:
  // Watched before they are read: an edit between the two is seen later, not never.
  State(const HotReloadOptions& options, HotReloadCallback callback)
      : options_(options), callback_(std::move(callback)), watch_(options.folders, options.settle) {}

  ~State() {
    {
      const std::scoped_lock lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  Status read_first() {
    Result<Registry> registry = load_registry(options_.folders);
    if (!registry) return tl::unexpected(registry.error());
    registry_ = std::make_shared<const Registry>(*std::move(registry));
    return {};
  }

  void start_thread() {
    if (options_.interval.count() > 0) thread_ = std::thread([this] { run(); });
  }

  HotProgramId add(HotProgram program) {
    const std::scoped_lock lock(mutex_);
    const HotProgramId id = ++last_id_;
    programs_.emplace(id, WatchedProgram{std::make_shared<const HotProgram>(std::move(program)), {}, {}, {}, true});
    has_new_ = true;
    wake_.notify_all();
    return id;
  }

  void remove(HotProgramId id) {
    const std::scoped_lock lock(mutex_);
    programs_.erase(id);
  }

  std::shared_ptr<const HotProgramState> current(HotProgramId id) const {
    const std::scoped_lock lock(mutex_);
    const auto found = programs_.find(id);
    return found == programs_.end() ? nullptr : found->second.state;
  }

  std::shared_ptr<const Registry> registry() const {
    const std::scoped_lock lock(mutex_);
    return registry_;
  }

  HotReloadCounts counts() const {
    const std::scoped_lock lock(mutex_);
    return counts_;
  }

  std::size_t poll() {
    bool is_free = false;
    if (!polling_.compare_exchange_strong(is_free, true)) return 0;
    struct Release {
      std::atomic<bool>& flag;
      ~Release() { flag = false; }
    } release{polling_};  // whatever look() throws
    const std::size_t reloaded = look();
    is_waiting_ = watch_.is_waiting();
    return reloaded;
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
      lock.unlock();
      try {
        poll();
      } catch (const std::bad_alloc&) {  // nobody is there to tell; the next look may have the memory
      }
      const auto pause = is_waiting_ ? std::min(options_.interval, options_.settle) : options_.interval;
      lock.lock();
      wake_.wait_for(lock, pause, [this] { return stopping_ || has_new_; });
      has_new_ = false;
    }
  }

  std::size_t look() {
    SourceChanges changes;
    if (watch_.has_settled_change(FolderWatch::Clock::now())) changes = load();
    try {
      std::vector<Recompilation> work = collect(changes);
      recompile(*registry_, work, options_.threads);
      return tell(work);
    } catch (...) {  // what was collected is not to be lost: the next look takes every program
      const std::scoped_lock lock(mutex_);
      for (auto& [id, program] : programs_) program.is_new = true;
      throw;
    }
  }

  /// Reads everything anew. What cannot be read leaves the registry as it was.
  SourceChanges load() {
    Result<Registry> loaded = load_registry(options_.folders);
    {
      const std::scoped_lock lock(mutex_);
      ++counts_.loads;
    }
    if (!loaded) {
      if (registry_error_ && is_same(*registry_error_, loaded.error())) return {};
      registry_error_ = loaded.error();
      call({{}, nullptr, loaded.error()});
      return {};
    }
    SourceChanges changes = changes_between(registry_->sources, loaded->sources);
    auto registry = std::make_shared<const Registry>(*std::move(loaded));
    {
      const std::scoped_lock lock(mutex_);
      registry_.swap(registry);
    }
    if (registry_error_) {
      registry_error_.reset();
      call({});
    }
    return changes;
  }

  /// The programs that may have changed, as they are now.
  std::vector<Recompilation> collect(const SourceChanges& changes) {
    const std::scoped_lock lock(mutex_);
    ++counts_.looks;
    std::vector<Recompilation> work;
    for (auto& [id, program] : programs_) {
      if (!program.is_new && !may_have_changed(program, changes)) continue;
      program.is_new = false;
      work.push_back({id, program, {}, {}, {}, false});
    }
    return work;
  }

  std::size_t tell(std::vector<Recompilation>& work) {
    std::vector<HotReloadEvent> events;
    std::size_t reloaded = 0;
    {
      const std::scoped_lock lock(mutex_);
      counts_.composed += work.size();
      for (Recompilation& done : work) {
        counts_.compiled += done.was_compiled ? 1 : 0;
        const auto program = programs_.find(done.id);
        if (program == programs_.end()) continue;
        add_event(done, program->second, events);
      }
    }
    for (HotReloadEvent& event : events) reloaded += call(std::move(event));
    return reloaded;
  }

  /// Names no program that was removed meanwhile. Returns whether a program is new.
  std::size_t call(HotReloadEvent event) {
    const bool names_programs = !event.programs.empty();
    {
      const std::scoped_lock lock(mutex_);
      if (stopping_) return 0;
      std::erase_if(event.programs, [this](HotProgramId id) { return !programs_.contains(id); });
    }
    if (names_programs && event.programs.empty()) return 0;
    if (callback_) callback_(event);
    return event.state ? 1 : 0;
  }

  const HotReloadOptions options_;
  const HotReloadCallback callback_;
  std::atomic<bool> polling_ = false, is_waiting_ = false;

  // Of whoever polls.
  FolderWatch watch_;
  std::optional<Error> registry_error_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false, has_new_ = false;
  HotProgramId last_id_ = 0;
  std::map<HotProgramId, WatchedProgram> programs_;
  HotReloadCounts counts_;
  std::shared_ptr<const Registry> registry_;  ///< replaced by whoever polls alone, who reads it without the lock

  std::thread thread_;
};

Result<std::unique_ptr<HotReloader>> HotReloader::create(const HotReloadOptions& options, HotReloadCallback callback) {
  auto state = std::make_unique<State>(options, std::move(callback));
  if (Status status = state->read_first(); !status) return tl::unexpected(status.error());
  state->start_thread();
  return std::unique_ptr<HotReloader>(new HotReloader(std::move(state)));
}

HotReloader::HotReloader(std::unique_ptr<State> state) : state_(std::move(state)) {}
HotReloader::~HotReloader() = default;

HotProgramId HotReloader::add(HotProgram program) {
  return state_->add(std::move(program));
}

void HotReloader::remove(HotProgramId id) {
  state_->remove(id);
}

std::shared_ptr<const HotProgramState> HotReloader::current(HotProgramId id) const {
  return state_->current(id);
}

std::size_t HotReloader::poll() {
  return state_->poll();
}

std::shared_ptr<const Registry> HotReloader::registry() const {
  return state_->registry();
}

HotReloadCounts HotReloader::counts() const {
  return state_->counts();
}

}  // namespace relievo
