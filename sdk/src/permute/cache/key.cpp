#include <xxhash.h>
#include <memory>

#include "permute/cache/little_endian.hpp"
#include "relievo/cache.hpp"

namespace relievo {

std::string to_string(const CacheKey& key) {
  constexpr char digits[] = "0123456789abcdef";
  std::string text(32, '0');
  for (std::size_t i = 0; i < 16; ++i) {
    text[15 - i] = digits[(key.high >> (4 * i)) & 15];
    text[31 - i] = digits[(key.low >> (4 * i)) & 15];
  }
  return text;
}

CacheKey cache_key(std::span<const std::string_view> parts) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  if (!state) throw std::bad_alloc();
  XXH3_128bits_reset(state.get());
  for (const std::string_view part : parts) {
    char length[8];
    cache::put_u64(length, part.size());
    XXH3_128bits_update(state.get(), length, sizeof length);
    XXH3_128bits_update(state.get(), part.data(), part.size());
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  return {hash.high64, hash.low64};
}

}  // namespace relievo
