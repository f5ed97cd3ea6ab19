#include "permute/cache/write.hpp"

#include <sys/resource.h>
#include <sys/uio.h>
#include <algorithm>
#include <cerrno>

namespace relievo::cache {

namespace {

/// Writing beyond it raises SIGXFSZ, which ends a process that does not expect it.
bool exceeds_file_limit(std::size_t bytes) {
  rlimit limit{};
  return ::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && bytes > limit.rlim_cur;
}

}  // namespace

int write_all(int fd, std::string_view first, std::string_view second) {
  if (exceeds_file_limit(first.size() + second.size())) return EFBIG;
  while (!first.empty() || !second.empty()) {
    iovec parts[2] = {{const_cast<char*>(first.data()), first.size()},
                      {const_cast<char*>(second.data()), second.size()}};
    const ssize_t written = ::writev(fd, parts, 2);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    const auto from_first = std::min(first.size(), static_cast<std::size_t>(written));
    first.remove_prefix(from_first);
    second.remove_prefix(static_cast<std::size_t>(written) - from_first);
  }
  return 0;
}

}  // namespace relievo::cache
