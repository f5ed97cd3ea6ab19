#include <algorithm>
#include <memory>
#include <string>

#include "c_api/boundary.hpp"
#include "describe/origins.hpp"
#include "relievo/permute.hpp"

struct relievo_manifest {
  relievo::Manifest manifest;
  relievo::Registry registry;
  relievo::PermutationPlan plan;
};

struct relievo_summary {
  relievo::PermuteSummary summary;
};

namespace relievo::c_api {

namespace {

Result<std::unique_ptr<relievo_manifest>> load(const char* path, const std::vector<std::string>& more_folders) {
  auto handle = std::make_unique<relievo_manifest>();
  Result<Manifest> manifest = load_manifest(path);
  if (!manifest) return tl::unexpected(manifest.error());
  handle->manifest = *std::move(manifest);
  std::vector<std::filesystem::path> folders = handle->manifest.folders;
  folders.insert(folders.end(), more_folders.begin(), more_folders.end());
  Result<Registry> registry = load_registry(folders);
  if (!registry) return tl::unexpected(registry.error());
  handle->registry = *std::move(registry);
  Result<PermutationPlan> plan = plan_permutations(handle->registry, handle->manifest);
  if (!plan) return tl::unexpected(plan.error());
  handle->plan = *std::move(plan);
  return handle;
}

Result<std::unique_ptr<Cache>> open_cache_of(const relievo_permute_desc& desc) {
  if (!desc.cache) return nullptr;
  const std::string place = desc.cache;
  CacheOptions options;
  if (desc.cache_bytes != 0) options.max_bytes = desc.cache_bytes;
  if (place.find("://") == std::string::npos) {
    options.folder = place;
  } else {
    options.remote = place;
  }
  return open_cache(options);
}

PermuteOptions options_of(const relievo_permute_desc& desc) {
  PermuteOptions options;
  options.threads = desc.threads;
  options.shard = {desc.shard_index, std::max(1u, desc.shard_count)};
  options.keep_going = desc.keep_going != 0;
  if (desc.progress) {
    options.progress = [report = desc.progress, user = desc.user](const PermuteProgress& now) {
      report(user, now.done, now.total);
    };
  }
  return options;
}

/// The run came to its end, with errors in its summary.
Status first_error(const PermuteSummary& summary) {
  if (summary.errors.empty()) return {};
  Error error = summary.errors.front().error;
  error.code = ErrorCode::compile;
  return tl::unexpected(std::move(error));
}

Status run(const relievo_manifest& handle, const relievo_permute_desc& desc, relievo_summary** summary) {
  PermuteOptions options = options_of(desc);
  if (options.shard.index >= options.shard.count) {
    return fail(ErrorCode::usage, "permute.shard",
                "'shard_index' is " + std::to_string(options.shard.index) + "; a number below " +
                    std::to_string(options.shard.count) + " is expected");
  }
  const Result<std::unique_ptr<Cache>> cache = open_cache_of(desc);
  if (!cache) return tl::unexpected(cache.error());
  options.cache = cache->get();
  Result<PermuteSummary> result = permute(handle.registry, handle.manifest, handle.plan, desc.archive, options);
  if (!result) return tl::unexpected(result.error());
  for (FoldedError& folded : result->errors) folded.error = name_file_on_disk(std::move(folded.error), handle.registry);
  Status status = first_error(*result);
  *summary = new relievo_summary{*std::move(result)};
  return status;
}

}  // namespace

}  // namespace relievo::c_api

using namespace relievo;
using namespace relievo::c_api;

relievo_status relievo_manifest_load(const char* path, const char* const* folders, size_t folder_count,
                                     relievo_manifest** manifest, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"path", path}, {"manifest", manifest}}); !status) return status;
    const Result<std::vector<std::string>> more_folders = texts_of("folders", folders, folder_count);
    if (!more_folders) return tl::unexpected(more_folders.error());
    auto handle = load(path, *more_folders);
    if (!handle) return tl::unexpected(handle.error());
    *manifest = handle->release();
    return {};
  });
}

void relievo_manifest_free(relievo_manifest* manifest) {
  delete manifest;
}

relievo_status relievo_manifest_counts(const relievo_manifest* manifest, size_t* asked, size_t* kept,
                                       relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"manifest", manifest}, {"asked", asked}, {"kept", kept}}); !status) return status;
    const auto& permutations = manifest->plan.permutations;
    *asked = permutations.size();
    *kept = static_cast<std::size_t>(std::count_if(permutations.begin(), permutations.end(),
                                                   [](const PlannedPermutation& p) { return p.is_kept(); }));
    return {};
  });
}

relievo_status relievo_manifest_name(const relievo_manifest* manifest, relievo_string* name, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"manifest", manifest}, {"name", name}}); !status) return status;
    *name = view(manifest->manifest.name);
    return {};
  });
}

relievo_status relievo_manifest_permute(const relievo_manifest* manifest, const relievo_permute_desc* desc,
                                        relievo_summary** summary, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"manifest", manifest}, {"desc", desc}, {"summary", summary}}); !status) return status;
    if (Status status = require({{"desc.archive", desc->archive}}); !status) return status;
    return run(*manifest, *desc, summary);
  });
}

void relievo_summary_free(relievo_summary* summary) {
  delete summary;
}

relievo_status relievo_summary_counts(const relievo_summary* summary, relievo_counts* counts, relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"summary", summary}, {"counts", counts}}); !status) return status;
    const PermuteSummary& s = summary->summary;
    *counts = {s.asked, s.pruned, s.closures, s.programs, s.from_cache, s.compiled, s.failed, s.errors.size()};
    return {};
  });
}

relievo_status relievo_summary_error(const relievo_summary* summary, size_t index, relievo_error* folded, size_t* count,
                                     relievo_error* error) {
  return at_boundary(error, [&]() -> Status {
    if (Status status = require({{"summary", summary}, {"folded", folded}, {"count", count}}); !status) return status;
    if (Status status = require_index(index, summary->summary.errors.size()); !status) return status;
    const FoldedError& found = summary->summary.errors[index];
    write_error(found.error, folded);
    *count = found.count;
    return {};
  });
}
