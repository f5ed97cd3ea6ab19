/// The Vulkan backend, with every program's arithmetic as inexact as Vulkan permits: what may happen on a device that
/// is not here.
#include <memory>
#include <utility>

#include "loosen.hpp"
#include "relievo/backend.hpp"

namespace relievo {

namespace backends {
extern const BackendFactory vulkan_factory;
}

namespace {

/// Loosening takes more time than what it loosens: times would tell nothing. What it stands for is no software driver.
BackendInfo loose_info(BackendInfo info) {
  info.name = "vulkan_loose";
  info.title += ", arithmetic as inexact as it may be";
  info.features.erase("timestamps");
  info.features.erase("software");
  return info;
}

class LooseBackend final : public Backend {
 public:
  explicit LooseBackend(std::unique_ptr<Backend> exact) : exact_(std::move(exact)), info_(loose_info(exact_->info())) {}

  const BackendInfo& info() const override { return info_; }

  Result<JobResult> execute(const Job& job) override {
    return keep_read_backs([&](const TakeReadBack& keep) { return execute_once(job, keep); });
  }

  Result<JobResult> execute_once(Job job, const TakeReadBack& take) override {
    loosen_programs(job);
    return without_times(exact_->execute_once(std::move(job), take));
  }

 private:
  void loosen_programs(Job& job) const {
    const bool has_float64 = info_.features.contains("float64");
    for (ShaderProgram& program : job.programs) {
      for (ShaderCode& shader : program.shaders) shader.spirv = loosen(shader.spirv, has_float64);
    }
  }

  static Result<JobResult> without_times(Result<JobResult> result) {
    if (result) result->command_seconds.clear();
    return result;
  }

  std::unique_ptr<Backend> exact_;
  BackendInfo info_;
};

BackendInfo probe_loose() {
  return loose_info(backends::vulkan_factory.probe());
}

Result<std::unique_ptr<Backend>> open_loose(const BackendOptions& options) {
  Result<std::unique_ptr<Backend>> exact = backends::vulkan_factory.open(options);
  if (!exact) return exact;
  return std::make_unique<LooseBackend>(*std::move(exact));
}

}  // namespace

namespace backends {
extern const BackendFactory vulkan_loose_factory;
const BackendFactory vulkan_loose_factory = {"vulkan_loose", probe_loose, open_loose};
}  // namespace backends

}  // namespace relievo
