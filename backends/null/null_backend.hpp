/// The null backend: does no work, writes down what a real one would do, and fails on demand.
#pragma once

#include <string>
#include <vector>

#include "relievo/backend.hpp"

namespace relievo {

class NullBackend final : public Backend {
 public:
  explicit NullBackend(const BackendOptions& options);

  const BackendInfo& info() const override { return info_; }

  /// Validates and records; every read-back is zero. With BackendOptions::fail_at_call = k, the k-th call since the
  /// backend was opened fails with "backend.injected".
  Result<JobResult> execute(const Job& job) override;

  /// One line a call, in order: `create program "relief"`, `dispatch "relief" 4x1x1`, `read back buffer "hits"`, ….
  const std::vector<std::string>& log() const { return log_; }

  /// Programs, buffers and textures that are created and not yet destroyed.
  int live_objects() const { return live_objects_; }

 private:
  class Run;

  BackendInfo info_;
  int fail_at_call_;
  std::vector<std::string> log_;
  int live_objects_ = 0;
};

}  // namespace relievo
