/// 64-bit numbers in files and in what is hashed: the same bytes on every machine.
#pragma once

#include <cstdint>

namespace relievo::cache {

inline void put_u64(char* to, std::uint64_t value) {
  for (int i = 0; i < 8; ++i) to[i] = static_cast<char>(value >> (8 * i));
}

inline std::uint64_t get_u64(const char* from) {
  std::uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value |= std::uint64_t{static_cast<unsigned char>(from[i])} << (8 * i);
  return value;
}

}  // namespace relievo::cache
