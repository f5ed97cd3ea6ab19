#include "bake_memory.hpp"

#include <algorithm>
#include <numeric>

#ifdef __linux__
#include <sys/resource.h>
#endif

namespace relievo::cli {

Result<JobResult> MeteredBackend::execute(const Job& job) {
  peak_ = std::max(peak_, resource_bytes(job));
  Result<JobResult> result = backend_.execute(job);
  if (result) seconds_ += std::accumulate(result->command_seconds.begin(), result->command_seconds.end(), 0.0);
  return result;
}

std::size_t process_peak_bytes() {
#ifdef __linux__
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) == 0) return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // in KiB
#endif
  return 0;
}

}  // namespace relievo::cli
