/// Keeps a folder within its bytes: entries that were used longest ago go first.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "permute/cache/usage.hpp"

namespace relievo::cache {

/// Safe for any number of threads and processes. Readers are not disturbed: a file that is open outlives its removal.
class SizeBound {
 public:
  SizeBound(std::string folder, std::uint64_t max_bytes);
  ~SizeBound();
  SizeBound(const SizeBound&) = delete;
  SizeBound& operator=(const SizeBound&) = delete;

  /// Books bytes that are about to be written; returns how many entries had to go for them.
  std::uint64_t book(std::uint64_t bytes);
  /// Gives back bytes that were not written after all.
  void unbook(std::uint64_t bytes);

  /// What one entry may have at most.
  std::uint64_t largest_entry() const { return max_bytes_ / 2; }

 private:
  std::uint64_t book_batch(std::uint64_t bytes);

  const std::string folder_;
  const std::uint64_t max_bytes_;
  std::mutex mutex_;
  std::uint64_t booked_ = 0;  ///< and not yet used
  std::uint64_t generation_ = 0;
  std::chrono::milliseconds patience_{1000};  ///< with the lock's holder; none after it was in vain
};

}  // namespace relievo::cache
