/// A job's programs as Vulkan pipelines, each made once.
#pragma once

#include <utility>
#include <vector>

#include "device.hpp"
#include "relievo/job.hpp"

namespace relievo::vulkan {

/// What the shaders of a program are compiled into, and the layout of its resources.
struct DeviceProgram {
  std::vector<Unique<VkDescriptorSetLayout>> set_layouts;  ///< one a set number; sets that are not used are empty
  Unique<VkPipelineLayout> layout;
  std::vector<Unique<VkShaderModule>> modules;  ///< in the order of ShaderProgram::shaders
};

class Pipelines {
 public:
  /// Checks and loads every program. Throws "backend.spirv" and "backend.feature".
  Pipelines(const Device& device, const Job& job, VkPipelineCache cache);

  const DeviceProgram& program(int index) const { return programs_[static_cast<std::size_t>(index)]; }

  VkPipeline compute(int program);
  /// Draws that differ only in what they bind, how much they draw and what they clear share a pipeline.
  VkPipeline graphics(const Draw& draw);

 private:
  Unique<VkPipeline> make_compute(int program) const;
  Unique<VkPipeline> make_graphics(const Draw& draw) const;
  bool same_pipeline(const Draw& a, const Draw& b) const;
  std::vector<VkFormat> color_formats(const Draw& draw) const;

  const Device& device_;
  const Job& job_;
  VkPipelineCache cache_;
  std::vector<DeviceProgram> programs_;
  std::vector<std::pair<int, Unique<VkPipeline>>> compute_;
  std::vector<std::pair<const Draw*, Unique<VkPipeline>>> graphics_;
};

}  // namespace relievo::vulkan
