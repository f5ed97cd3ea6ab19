/// Running one job.
#pragma once

#include "device.hpp"
#include "relievo/job.hpp"

namespace relievo::vulkan {

/// Creates what a valid job needs, runs its commands in order, and returns what it reads back, without messages.
JobResult run_job(Device& device, const Job& job, VkPipelineCache cache);

}  // namespace relievo::vulkan
