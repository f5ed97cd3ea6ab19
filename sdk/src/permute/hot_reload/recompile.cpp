#include "permute/hot_reload/recompile.hpp"

#include <algorithm>
#include <exception>
#include <tuple>
#include <utility>

#include "compile/parallel.hpp"
#include "describe/origins.hpp"
#include "permute/fold_errors.hpp"

namespace relievo {

namespace {

/// As one error of many programs is told: at the author's file, without the permutation's name.
Error common_error(const Registry& registry, const Error& error, const std::string& key) {
  ErrorFolder folder;
  folder.add(name_file_on_disk(error, registry), key, key, 1);
  return folder.take().front().error;
}

bool is_unchanged(const ComposedProgram* before, const CacheKey& now) {
  return before && fingerprint(*before) == now;
}

void run(const Registry& registry, Recompilation& item) {
  const HotProgram& wanted = *item.before.program;
  const std::string key = wanted.permutation.key();
  Result<ComposedProgram> composed = compose(registry, wanted.permutation);
  if (!composed) {
    item.error = common_error(registry, composed.error(), key);
    return;
  }
  const CacheKey now = fingerprint(*composed);
  // An edit that was taken back: nothing to compile, and the old error, if there is one, is gone or stays.
  if (is_unchanged(item.before.failed.get(), now)) {
    item.failed = item.before.failed;
    item.error = item.before.error;
    return;
  }
  if (item.before.state && is_unchanged(&item.before.state->composed, now)) return;
  item.was_compiled = true;
  const std::string& fallback = (*registry.stage(wanted.permutation.stage))->fallback;
  Result<CompiledProgram> compiled = compile(*composed, wanted.targets, wanted.options, fallback);
  if (compiled) {
    item.state = std::make_shared<HotProgramState>(HotProgramState{*std::move(composed), *std::move(compiled)});
    return;
  }
  item.error = common_error(registry, compiled.error(), key);
  item.failed = std::make_shared<const ComposedProgram>(*std::move(composed));
}

}  // namespace

bool is_same(const Error& a, const Error& b) {
  return std::tie(a.file, a.line, a.column, a.id, a.message) == std::tie(b.file, b.line, b.column, b.id, b.message);
}

bool may_have_changed(const WatchedProgram& program, const SourceChanges& changes) {
  if (changes.files.empty()) return false;
  if (program.failed) return reaches(changes, *program.failed);
  return program.error || !program.state || reaches(changes, program.state->composed);
}

void recompile(const Registry& registry, std::span<Recompilation> work, unsigned threads) {
  run_parallel(work.size(), threads, [&](std::size_t i) { run(registry, work[i]); });
}

void add_event(Recompilation& done, WatchedProgram& program, std::vector<HotReloadEvent>& events) {
  const std::optional<Error> before = std::exchange(program.error, done.error);
  program.failed = done.failed;
  if (done.error) {
    if (before && is_same(*before, *done.error)) return;
    const auto same = std::find_if(events.begin(), events.end(), [&](const HotReloadEvent& event) {
      return event.error && is_same(*event.error, *done.error);
    });
    if (same != events.end()) {
      same->programs.push_back(done.id);
    } else {
      events.push_back({{done.id}, nullptr, done.error});
    }
    return;
  }
  if (done.state) program.state = done.state;
  // A mended program that is what it was before is told as well: the error is no more.
  if (done.state || before) events.push_back({{done.id}, program.state, {}});
}

}  // namespace relievo
