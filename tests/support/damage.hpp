/// Damage to archives: bytes changed anywhere, with and without a hash that hides it.
#pragma once

#include <xxhash.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

namespace relievo::test {

/// Makes the hash of an archive's index right again (docs/archive.md: at 16, of the header from 24 to 256 and of what
/// begins at the offset at 32), so that the checks behind it are reached.
inline void mend_index_hash(std::string& bytes) {
  constexpr std::size_t header = 256;
  if (bytes.size() < header) return;
  std::uint64_t offset = 0;
  std::memcpy(&offset, bytes.data() + 32, sizeof offset);
  if (offset > bytes.size()) return;
  const std::string hashed = bytes.substr(24, header - 24) + bytes.substr(static_cast<std::size_t>(offset));
  const std::uint64_t hash = XXH3_64bits(hashed.data(), hashed.size());
  std::memcpy(bytes.data() + 16, &hash, sizeof hash);
}

/// The same of a program's bytes: at 8, of all from 16.
inline void mend_program_hash(std::string& bytes) {
  if (bytes.size() < 16) return;
  const std::uint64_t hash = XXH3_64bits(bytes.data() + 16, bytes.size() - 16);
  std::memcpy(bytes.data() + 8, &hash, sizeof hash);
}

/// One to four accidents: a flipped bit, a byte, a word, a piece moved, a piece cut out, an end cut off.
inline std::string damaged(std::string bytes, std::mt19937& random) {
  for (unsigned accidents = 1 + random() % 4; accidents > 0 && bytes.size() > 8; --accidents) {
    const std::size_t at = random() % bytes.size(), length = random() % std::min<std::size_t>(64, bytes.size() - at);
    switch (random() % 6) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        break;
      case 1:
        bytes[at] = static_cast<char>(random());
        break;
      case 2: {
        const std::uint32_t word = random() % 2 == 0 ? static_cast<std::uint32_t>(random()) : 0xffffffffu;
        std::memcpy(&bytes[at / 4 * 4 + 4 <= bytes.size() ? at / 4 * 4 : 0], &word, sizeof word);
        break;
      }
      case 3:
        std::memmove(&bytes[random() % (bytes.size() - length)], &bytes[at], length);
        break;
      case 4:
        bytes.erase(at, length);
        break;
      default:
        bytes.resize(random() % 8 == 0 ? at : bytes.size() - length % 8);
    }
  }
  return bytes;
}

}  // namespace relievo::test
