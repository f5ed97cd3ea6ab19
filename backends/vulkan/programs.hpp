/// Loading a program: its SPIR-V is checked, its shader modules and layouts are made.
#pragma once

#include <vector>

#include "device.hpp"
#include "pipelines.hpp"
#include "relievo/job.hpp"

namespace relievo::vulkan {

VkShaderStageFlagBits stage_flag(ShaderStage stage);
VkDescriptorType descriptor_type(ResourceKind kind);

DeviceProgram load_program(const Device& device, const ShaderProgram& program);

/// The specialization constants of a program, for as long as a pipeline is being made.
class Specialization {
 public:
  explicit Specialization(const ShaderProgram& program);
  Specialization(const Specialization&) = delete;
  Specialization& operator=(const Specialization&) = delete;

  const VkSpecializationInfo* info() const { return &info_; }

 private:
  std::vector<VkSpecializationMapEntry> entries_;
  VkSpecializationInfo info_;
};

}  // namespace relievo::vulkan
