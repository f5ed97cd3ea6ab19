#include "permute/cache/entry.hpp"

#include <fmt/format.h>
#include <xxhash.h>
#include <algorithm>

#include "permute/cache/little_endian.hpp"

namespace relievo::cache {

namespace {

constexpr std::string_view kMagic = "RlvEntry";

CacheKey payload_hash(const CacheKey& key, std::string_view payload) {
  char bytes[16];
  put_u64(bytes, key.high);
  put_u64(bytes + 8, key.low);
  const XXH128_hash_t hash = XXH3_128bits_withSeed(payload.data(), payload.size(), XXH3_64bits(bytes, sizeof bytes));
  return {hash.high64, hash.low64};
}

CacheKey get_key(const char* from) {
  return {get_u64(from), get_u64(from + 8)};
}

void put_key(char* to, const CacheKey& key) {
  put_u64(to, key.high);
  put_u64(to + 8, key.low);
}

}  // namespace

EntryHeader entry_header(const CacheKey& key, std::string_view payload) {
  EntryHeader header{};
  std::copy(kMagic.begin(), kMagic.end(), header.begin());
  put_u64(&header[8], kEntryVersion);
  put_key(&header[16], key);
  put_u64(&header[32], payload.size());
  put_key(&header[40], payload_hash(key, payload));
  return header;
}

std::string entry_fault(std::string_view header, std::string_view payload, const CacheKey& key) {
  if (header.size() != kHeaderSize)
    return fmt::format("it has {} bytes; expected at least {}", header.size(), kHeaderSize);
  if (header.substr(0, kMagic.size()) != kMagic) return fmt::format("it does not start with '{}'", kMagic);
  if (const std::uint64_t version = get_u64(&header[8]); version != kEntryVersion)
    return fmt::format("its format has version {}; expected {}", version, kEntryVersion);
  if (const CacheKey found = get_key(&header[16]); found != key)
    return fmt::format("it holds key {}; expected {}", to_string(found), to_string(key));
  if (const std::uint64_t size = get_u64(&header[32]); size != payload.size())
    return fmt::format("its payload has {} bytes; expected {}", payload.size(), size);
  const CacheKey stored = get_key(&header[40]), hash = payload_hash(key, payload);
  if (hash == stored) return {};
  return fmt::format("its payload hashes to {}; expected {}", to_string(hash), to_string(stored));
}

std::string entry_fault(std::string_view bytes, const CacheKey& key) {
  const std::size_t split = std::min(bytes.size(), kHeaderSize);
  return entry_fault(bytes.substr(0, split), bytes.substr(split), key);
}

}  // namespace relievo::cache
