/// What a fuzz target calls when an answer is wrong, so that the fuzzer keeps the input.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace relievo::fuzz {

/// Ends the process unless `fault` is empty.
inline void expect_none(std::string_view fault) {
  if (fault.empty()) return;
  std::fprintf(stderr, "fault: %.*s\n", static_cast<int>(fault.size()), fault.data());
  std::abort();
}

}  // namespace relievo::fuzz
