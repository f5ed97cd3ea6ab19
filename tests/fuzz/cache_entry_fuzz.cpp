/// Any bytes as a cache entry: refused, or the payload that its header was made from.
#include "fuzz/check.hpp"
#include "permute/cache/entry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace relievo;
  const CacheKey key{0x0123456789abcdef, 0xfedcba9876543210};
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto sound = [&](std::string_view entry) { return cache::entry_fault(entry, key).empty(); };
  if (sound(bytes)) {
    const cache::EntryHeader header = cache::entry_header(key, bytes.substr(cache::kHeaderSize));
    if (bytes.substr(0, cache::kHeaderSize) != std::string_view(header.data(), header.size()))
      fuzz::expect_none("a header is accepted that nobody writes");
  }
  // The input as a payload: sound, until anything changes.
  const cache::EntryHeader header = cache::entry_header(key, bytes);
  std::string entry(header.data(), header.size());
  entry += bytes;
  if (!sound(entry)) fuzz::expect_none("an entry is refused that was written");
  const std::size_t at = size == 0 ? 0 : (data[0] * std::size_t{131}) % entry.size();
  entry[at] = static_cast<char>(entry[at] ^ (size > 1 && data[1] != 0 ? data[1] : 1));
  if (sound(entry)) fuzz::expect_none("a damaged entry is accepted");
  return 0;
}
