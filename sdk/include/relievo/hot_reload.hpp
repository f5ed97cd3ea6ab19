/// Programs that follow their sources while an application runs (docs/hot-reload.md).
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "relievo/compile.hpp"

namespace relievo {

/// A program that a reloader keeps up to date.
struct HotProgram {
  Permutation permutation;
  std::vector<Target> targets;
  CompileOptions options;
};

/// Of one reloader; never used again.
using HotProgramId = std::uint64_t;

/// A program in use: what it was composed of, and what came out.
struct HotProgramState {
  ComposedProgram composed;
  CompiledProgram compiled;
};

/// What a reloader tells. Without an error: `state` is what `programs`, one of them, is from now on; when no program is
/// named, what was wrong with the folders is mended. With an error: `programs` stay what they were; when none is named,
/// a descriptor or folder is wrong, and all stay what they were.
struct HotReloadEvent {
  std::vector<HotProgramId> programs;
  std::shared_ptr<const HotProgramState> state;
  std::optional<Error> error;  ///< at the author's file and line; without the permutation's key
};

/// May call every function of the reloader but its destructor. Must not throw.
using HotReloadCallback = std::function<void(const HotReloadEvent&)>;

struct HotReloadOptions {
  std::vector<std::filesystem::path> folders;  ///< of technique, map and stage folders, besides our own
  /// Between two looks of the reloader's own thread; 0: no thread, the application calls `poll`.
  std::chrono::milliseconds interval{100};
  /// Files must have stayed as they are for this long: an editor may truncate before it writes.
  std::chrono::milliseconds settle{50};
  unsigned threads = 1;  ///< for compiling several programs; 0 = all
};

/// What a reloader did since it began.
struct HotReloadCounts {
  std::uint64_t looks = 0;     ///< at names, sizes and times
  std::uint64_t loads = 0;     ///< of all sources, since something looked different
  std::uint64_t composed = 0;  ///< programs that a changed file may have reached
  std::uint64_t compiled = 0;  ///< of them, those that came out different; with those that failed
};

/// Watches folders by looking at names, sizes and modification times, and compares contents when these differ: a file
/// that is only touched does nothing. Editors that write by renaming, or truncate and write, are waited for.
/// Every function but the destructor is thread-safe. The callback comes from the reloader's own thread, or from `poll`,
/// one at a time.
class HotReloader {
 public:
  /// Reads the folders once, before it returns. Errors: those of `load_registry`.
  static Result<std::unique_ptr<HotReloader>> create(const HotReloadOptions& options, HotReloadCallback callback);
  HotReloader(const HotReloader&) = delete;
  HotReloader& operator=(const HotReloader&) = delete;
  ~HotReloader();  ///< waits for a callback that is running; no other comes

  /// Compiled at the next look, at once by a thread of its own: the callback gets it, or its error.
  HotProgramId add(HotProgram program);
  /// Only a callback that is under way may still name the program.
  void remove(HotProgramId id);
  /// The program as it was last told; null before, and for one that is not there.
  std::shared_ptr<const HotProgramState> current(HotProgramId id) const;

  /// Looks once, and recompiles what has to be; returns how many programs the callback was told to be new. Does
  /// nothing when called by the callback, or while another thread polls.
  std::size_t poll();

  /// What the folders held when they were last read without an error. Never null.
  std::shared_ptr<const Registry> registry() const;
  HotReloadCounts counts() const;

 private:
  class State;
  explicit HotReloader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace relievo
