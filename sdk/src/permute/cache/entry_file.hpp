/// One entry's file: read and checked, or written whole.
#pragma once

#include <string>
#include <string_view>

#include "permute/cache/entry.hpp"

namespace relievo::cache {

struct EntryRead {
  enum class State {
    absent,
    sound,
    damaged,     ///< and removed
    unreadable,  ///< no permission, too many open files, …: left as it is
  };
  State state = State::absent;
  std::string payload;
  std::string fault;  ///< a clause
};

enum class Touch { no, yes };

/// With `Touch::yes`, a sound entry that was not used for minutes becomes one that was used now.
EntryRead read_entry_file(const std::string& path, const CacheKey& key, Touch touch);

/// Makes the folder when it is absent. Returns 0, or the errno of what failed; then nothing is left behind.
int write_entry_file(const std::string& path, std::string_view header, std::string_view payload);

}  // namespace relievo::cache
