/// Running one job.
#pragma once

#include <functional>

#include "device.hpp"
#include "pipelines.hpp"
#include "relievo/backend.hpp"

namespace relievo::vulkan {

/// Creates what a valid job needs, runs its commands in order, and hands over what it reads back; the result has the
/// times alone. Calls `uploaded` once the job's contents are not needed any more.
JobResult run_job(Device& device, const Job& job, VkPipelineCache cache, RecentPrograms<DeviceProgram>& recent,
                  const std::function<void()>& uploaded, const TakeReadBack& take);

}  // namespace relievo::vulkan
