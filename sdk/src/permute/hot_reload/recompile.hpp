/// From programs that may have changed to what a reloader tells of them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "permute/hot_reload/reach.hpp"
#include "relievo/hot_reload.hpp"

namespace relievo {

/// What a reloader knows of a program.
struct WatchedProgram {
  std::shared_ptr<const HotProgram> program;
  std::shared_ptr<const HotProgramState> state;   ///< as it was told; null before
  std::shared_ptr<const ComposedProgram> failed;  ///< what did not compile, while it does not
  std::optional<Error> error;                     ///< as it was told, while there is one
  bool is_new = true;
};

/// A program that composes no more is tried again after every change.
bool may_have_changed(const WatchedProgram& program, const SourceChanges& changes);

/// A program to be recompiled, as it was before, and what came out.
struct Recompilation {
  HotProgramId id = 0;
  WatchedProgram before;
  std::shared_ptr<HotProgramState> state;  ///< null where nothing was compiled, or not with success
  std::shared_ptr<const ComposedProgram> failed;
  std::optional<Error> error;
  bool was_compiled = false;
};

/// Composes all, and compiles those that came out different from what they were.
void recompile(const Registry& registry, std::span<Recompilation> work, unsigned threads);

bool is_same(const Error& a, const Error& b);

/// Brings the program up to date, and adds what is to be told of it, if anything: one event for programs with the same
/// error.
void add_event(Recompilation& done, WatchedProgram& program, std::vector<HotReloadEvent>& events);

}  // namespace relievo
