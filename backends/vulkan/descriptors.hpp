/// What a command binds, as descriptor sets.
#pragma once

#include <vector>

#include "device.hpp"
#include "pipelines.hpp"
#include "relievo/job.hpp"
#include "resources.hpp"

namespace relievo::vulkan {

/// The slot of a program that a binding fills; validate_job() has made sure that there is one.
const BindingSlot& slot_of(const ShaderProgram& program, const ResourceBinding& binding);

class Descriptors {
 public:
  /// Room for everything that the job's commands bind.
  Descriptors(const Device& device, const Job& job);

  /// Binds a command's resources. Images must be in the layout that they are used in already.
  void bind(VkCommandBuffer commands, VkPipelineBindPoint point, const ShaderProgram& program,
            const DeviceProgram& loaded, const std::vector<ResourceBinding>& bindings, Resources& resources);

 private:
  std::vector<VkDescriptorSet> allocate(const DeviceProgram& loaded);
  void write(VkDescriptorSet set, const BindingSlot& slot, int resource, Resources& resources);

  const Device& device_;
  const Job& job_;
  Unique<VkDescriptorPool> pool_;
};

}  // namespace relievo::vulkan
