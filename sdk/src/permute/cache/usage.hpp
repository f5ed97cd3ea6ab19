/// The bytes in a cache folder, counted without listing it: in the file `usage`, changed under its lock.
///
/// A process books bytes before it writes them, a batch at a time, and gives back at its end what it did not use. A
/// killed process so leaves the count too high, never too low; whoever then finds the folder full lists it, and counts
/// anew. A count that is damaged does the same.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "permute/cache/file_descriptor.hpp"

namespace relievo::cache {

struct Usage {
  std::uint64_t bytes = 0;
  std::uint64_t generation = 0;  ///< changes when the folder was counted anew, which forgets what others had booked
};

std::uint64_t new_generation();

/// The file `usage`, locked against other processes and threads until it goes out of scope.
class UsageFile {
 public:
  enum class Absent { make, leave };
  /// Nothing where the lock is not to be had in time: its holder may have been stopped.
  static std::optional<UsageFile> lock(const std::string& folder, Absent absent,
                                       std::chrono::milliseconds patience = std::chrono::seconds(1));

  /// Nothing when the file is new, or damaged.
  std::optional<Usage> read() const;
  void write(const Usage& usage) const;

 private:
  explicit UsageFile(FileDescriptor file) : file_(std::move(file)) {}
  FileDescriptor file_;
};

}  // namespace relievo::cache
