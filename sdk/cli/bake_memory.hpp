/// What a bake takes: memory at its peak, and time on the device.
#pragma once

#include <cstddef>

#include "relievo/backend.hpp"

namespace relievo::cli {

/// Hands Jobs on; keeps the bytes of the largest, and the seconds that the driver says their commands took.
class MeteredBackend : public Backend {
 public:
  explicit MeteredBackend(Backend& backend) : backend_(backend) {}
  const BackendInfo& info() const override { return backend_.info(); }
  Result<JobResult> execute(const Job& job) override;
  Result<JobResult> execute_once(Job job, const TakeReadBack& take) override;
  std::size_t peak_bytes() const { return peak_; }
  double command_seconds() const { return seconds_; }  ///< 0 without timestamps

 private:
  Result<JobResult> measured(Result<JobResult> result);

  Backend& backend_;
  std::size_t peak_ = 0;
  double seconds_ = 0;
};

/// From now on memory that is freed goes back to the system at once, not when the allocator next looks: maps are large.
void return_freed_memory();

/// The most memory that this process has had resident so far; 0 where the system does not say.
std::size_t process_peak_bytes();

}  // namespace relievo::cli
