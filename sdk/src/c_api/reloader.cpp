#include <chrono>
#include <memory>
#include <optional>
#include <type_traits>

#include "c_api/boundary.hpp"
#include "c_api/permutation.hpp"
#include "c_api/program.hpp"
#include "relievo/hot_reload.hpp"

struct relievo_reloader {
  std::unique_ptr<relievo::HotReloader> reloader;
};

namespace relievo::c_api {

namespace {

void call(relievo_reload_callback callback, void* user, const HotReloadEvent& event) {
  std::optional<relievo_program> program;
  if (event.state) program.emplace(event.state);
  relievo_error error;
  if (event.error) write_error(*event.error, &error);
  const relievo_reload_event told{event.programs.data(), event.programs.size(), program ? &*program : nullptr,
                                  event.error ? &error : nullptr};
  callback(user, &told);
}

Result<HotReloadOptions> options_of(const relievo_reload_desc& desc) {
  const Result<std::vector<std::string>> folders = texts_of("desc.folders", desc.folders, desc.folder_count);
  if (!folders) return tl::unexpected(folders.error());
  HotReloadOptions options;
  options.folders.assign(folders->begin(), folders->end());
  options.interval = std::chrono::milliseconds(desc.interval_ms);
  if (desc.settle_ms != 0) options.settle = std::chrono::milliseconds(desc.settle_ms);
  options.threads = desc.threads;
  return options;
}

Result<HotProgram> hot_program_of(const Registry& registry, const relievo_program_desc& desc) {
  Result<Permutation> permutation = permutation_of(registry, desc);
  if (!permutation) return tl::unexpected(permutation.error());
  Result<std::vector<Target>> targets = targets_of(desc);
  if (!targets) return tl::unexpected(targets.error());
  return HotProgram{*std::move(permutation), *std::move(targets), compile_options_of(desc)};
}

}  // namespace

}  // namespace relievo::c_api

using namespace relievo;
using namespace relievo::c_api;

static_assert(std::is_same_v<relievo_reload_id, HotProgramId>);

relievo_status relievo_reloader_create(const relievo_reload_desc* desc, relievo_reloader** reloader,
                                       relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"desc", desc}, {"reloader", reloader}}); !status) return status;
    const Result<HotReloadOptions> options = options_of(*desc);
    if (!options) return tl::unexpected(options.error());
    HotReloadCallback callback;
    if (desc->callback)
      callback = [c = desc->callback, user = desc->user](const HotReloadEvent& event) { call(c, user, event); };
    auto handle = std::make_unique<relievo_reloader>();
    Result<std::unique_ptr<HotReloader>> created = HotReloader::create(*options, std::move(callback));
    if (!created) return tl::unexpected(created.error());
    handle->reloader = *std::move(created);
    *reloader = handle.release();
    return {};
  });
}

void relievo_reloader_free(relievo_reloader* reloader) {
  delete reloader;
}

relievo_status relievo_reloader_add(relievo_reloader* reloader, const relievo_program_desc* desc, relievo_reload_id* id,
                                    relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"reloader", reloader}, {"desc", desc}, {"id", id}}); !status) return status;
    Result<HotProgram> program = hot_program_of(*reloader->reloader->registry(), *desc);
    if (!program) return tl::unexpected(program.error());
    *id = reloader->reloader->add(*std::move(program));
    return {};
  });
}

relievo_status relievo_reloader_remove(relievo_reloader* reloader, relievo_reload_id id, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"reloader", reloader}}); !status) return status;
    reloader->reloader->remove(id);
    return {};
  });
}

relievo_status relievo_reloader_current(const relievo_reloader* reloader, relievo_reload_id id,
                                        relievo_program** program, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"reloader", reloader}, {"program", program}}); !status) return status;
    std::shared_ptr<const HotProgramState> state = reloader->reloader->current(id);
    *program = state ? new relievo_program(std::move(state)) : nullptr;
    return {};
  });
}

relievo_status relievo_reloader_poll(relievo_reloader* reloader, size_t* reloaded, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"reloader", reloader}, {"reloaded", reloaded}}); !status) return status;
    *reloaded = reloader->reloader->poll();
    return {};
  });
}

relievo_status relievo_reloader_counts(const relievo_reloader* reloader, relievo_reload_counts* counts,
                                       relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"reloader", reloader}, {"counts", counts}}); !status) return status;
    const HotReloadCounts done = reloader->reloader->counts();
    *counts = {done.looks, done.loads, done.composed, done.compiled};
    return {};
  });
}
