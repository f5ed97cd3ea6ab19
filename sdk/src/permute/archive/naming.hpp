/// Permutations in words, and the keys of their values.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "relievo/archive.hpp"

namespace relievo::archive {

/// "technique=relief address=clamp": the values that are not default; words for none of them.
std::string name_of(std::span<const ArchiveAxis> axes, std::span<const std::uint16_t> values);
/// Every axis, those that the permutation does not have as well.
std::string full_name_of(std::span<const ArchiveAxis> axes, std::span<const std::uint16_t> values);

/// What each value of each axis adds to a key: 0 for defaults.
class ValueKeys {
 public:
  explicit ValueKeys(std::span<const ArchiveAxis> axes);
  /// The key of a permutation; `values` must be in range.
  std::uint64_t key(std::span<const std::uint16_t> values) const;

 private:
  std::vector<std::uint64_t> keys_;    ///< of all axes, one after the other
  std::vector<std::uint32_t> firsts_;  ///< where an axis begins
};

/// The first rule of `ArchiveWriter::create` that the axes break, or empty.
std::string fault_of(std::span<const ArchiveAxis> axes);
/// Whether there is one value an axis, each in its range.
bool in_range(std::span<const ArchiveAxis> axes, std::span<const std::uint16_t> values);

}  // namespace relievo::archive
