#include "bake_memory.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#ifdef __linux__
#include <sys/resource.h>
#endif
#ifdef RELIEVO_HAS_MIMALLOC
#include <mimalloc.h>
#endif

namespace relievo::cli {

Result<JobResult> MeteredBackend::execute(const Job& job) {
  peak_ = std::max(peak_, resource_bytes(job));
  return measured(backend_.execute(job));
}

Result<JobResult> MeteredBackend::execute_once(Job job, const TakeReadBack& take) {
  peak_ = std::max(peak_, resource_bytes(job));
  return measured(backend_.execute_once(std::move(job), take));
}

Result<JobResult> MeteredBackend::measured(Result<JobResult> result) {
  if (result) seconds_ += std::accumulate(result->command_seconds.begin(), result->command_seconds.end(), 0.0);
  return result;
}

void return_freed_memory() {
#if defined(RELIEVO_HAS_MIMALLOC) && MI_MALLOC_VERSION < 210
  mi_option_set(mi_option_segment_decommit_delay, 0);
#elif defined(RELIEVO_HAS_MIMALLOC)
  mi_option_set(mi_option_purge_delay, 0);
#endif
}

std::size_t process_peak_bytes() {
#ifdef __linux__
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) == 0) return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // in KiB
#endif
  return 0;
}

}  // namespace relievo::cli
