/// A job's programs as Vulkan pipelines, each made once.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "device.hpp"
#include "job/recent_programs.hpp"
#include "relievo/job.hpp"

namespace relievo::vulkan {

/// What a draw's pipeline depends on besides the program. Draws that differ only in what they bind, how much they draw
/// and what they clear share a pipeline.
struct DrawState {
  CullMode cull = CullMode::none;
  bool has_depth = false;
  std::vector<VkFormat> color_formats;
  int vertex_stride = 0;
  std::vector<VertexAttribute> attributes;
  friend bool operator==(const DrawState&, const DrawState&) = default;
};

/// What the shaders of a program are compiled into, and the layout of its resources.
struct DeviceProgram {
  std::vector<Unique<VkDescriptorSetLayout>> set_layouts;  ///< one a set number; sets that are not used are empty
  Unique<VkPipelineLayout> layout;
  std::vector<Unique<VkShaderModule>> modules;  ///< in the order of ShaderProgram::shaders
  Unique<VkPipeline> compute;                   ///< null until it is asked for
  std::vector<std::pair<DrawState, Unique<VkPipeline>>> graphics;
};

class Pipelines {
 public:
  /// Checks and loads the programs that are not kept in `recent`, which keeps them then. Throws "backend.spirv" and
  /// "backend.feature".
  Pipelines(const Device& device, const Job& job, VkPipelineCache cache, RecentPrograms<DeviceProgram>& recent);

  const DeviceProgram& program(int index) const { return *programs_[static_cast<std::size_t>(index)]; }

  VkPipeline compute(int program);
  VkPipeline graphics(const Draw& draw);

 private:
  Unique<VkPipeline> make_compute(int program) const;
  Unique<VkPipeline> make_graphics(int program, const DrawState& state) const;
  DrawState state_of(const Draw& draw) const;

  const Device& device_;
  const Job& job_;
  VkPipelineCache cache_;
  std::vector<std::shared_ptr<DeviceProgram>> programs_;
};

}  // namespace relievo::vulkan
