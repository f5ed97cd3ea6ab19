/// Writing that fails by a number and never by a signal.
#pragma once

#include <string_view>

namespace relievo::cache {

/// Writes both, one after the other, to a new file. Returns 0 or an errno; EFBIG where the process may not write
/// so much (RLIMIT_FSIZE).
int write_all(int fd, std::string_view first, std::string_view second = {});

}  // namespace relievo::cache
