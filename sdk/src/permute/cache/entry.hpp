/// The bytes of a cache entry, in a file as in Redis: a header, then the payload. Any change of any byte is found.
///
/// | offset | bytes | holds                                                           |
/// |--------|-------|-----------------------------------------------------------------|
/// | 0      | 8     | "RlvEntry"                                                      |
/// | 8      | 8     | version of this format                                          |
/// | 16     | 16    | the key: high, low                                              |
/// | 32     | 8     | bytes of payload                                                |
/// | 40     | 16    | XXH3-128 of the payload, seeded by the key: high, low           |
/// | 56     | …     | payload, to the end                                             |
///
/// Numbers are little-endian.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "relievo/cache.hpp"

namespace relievo::cache {

inline constexpr std::size_t kHeaderSize = 56;
inline constexpr std::uint64_t kEntryVersion = 1;
/// What is larger is no program, but a file that somebody else put there.
inline constexpr std::uint64_t kMaxPayload = std::uint64_t{1} << 30;

using EntryHeader = std::array<char, kHeaderSize>;

EntryHeader entry_header(const CacheKey& key, std::string_view payload);

/// What is wrong with an entry that was found under `key`, as a clause ("its hash …"); empty when it is sound.
std::string entry_fault(std::string_view header, std::string_view payload, const CacheKey& key);

/// The same of header and payload in one piece, as they come from Redis.
std::string entry_fault(std::string_view bytes, const CacheKey& key);

}  // namespace relievo::cache
