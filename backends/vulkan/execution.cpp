#include "execution.hpp"

#include <algorithm>
#include <cmath>

#include "descriptors.hpp"
#include "formats.hpp"
#include "pipelines.hpp"
#include "resources.hpp"
#include "timestamps.hpp"

namespace relievo::vulkan {

namespace {

class Execution {
 public:
  Execution(Device& device, const Job& job, VkPipelineCache cache, RecentPrograms<DeviceProgram>& recent)
      : device_(device),
        job_(job),
        resources_(device, job),
        pipelines_(device, job, cache, recent),
        descriptors_(device, job),
        timestamps_(device, job.commands.size()) {}

  JobResult run(const std::function<void()>& uploaded, const TakeReadBack& take) {
    // Apart from the rest, so that what was only there to be copied is gone when the work begins.
    device_.run([this](VkCommandBuffer commands) { resources_.upload(commands); });
    resources_.end_upload();
    uploaded();
    device_.run([this](VkCommandBuffer commands) { record_all(commands); });
    resources_.read_back(take);
    return {{}, timestamps_.seconds(), {}};
  }

 private:
  void record_all(VkCommandBuffer commands) {
    timestamps_.reset(commands);
    for (std::size_t i = 0; i < job_.commands.size(); ++i) {
      resources_.barrier(commands, std::visit([this](const auto& c) { return transitions(c); }, job_.commands[i]));
      timestamps_.begin(commands, i);
      std::visit([&](const auto& command) { record(commands, command); }, job_.commands[i]);
      timestamps_.end(commands, i);
    }
    resources_.download(commands);
  }

  void record(VkCommandBuffer commands, const Dispatch& dispatch) {
    device_.vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_.compute(dispatch.program));
    bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, dispatch);
    device_.vk.vkCmdDispatch(commands, dispatch.groups[0], dispatch.groups[1], dispatch.groups[2]);
  }

  void record(VkCommandBuffer commands, const Draw& draw) {
    const VkPipeline pipeline = pipelines_.graphics(draw);
    begin_rendering(commands, draw);
    device_.vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    bind(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, draw);
    if (!draw.attributes.empty()) {
      const VkBuffer buffer = resources_.buffer(draw.vertex_buffer);
      const VkDeviceSize offset = 0;
      device_.vk.vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &offset);
    }
    if (draw.index_buffer >= 0) {
      device_.vk.vkCmdBindIndexBuffer(commands, resources_.buffer(draw.index_buffer), 0, VK_INDEX_TYPE_UINT32);
      device_.vk.vkCmdDrawIndexed(commands, draw.count, draw.instances, 0, 0, 0);
    } else {
      device_.vk.vkCmdDraw(commands, draw.count, draw.instances, 0, 0);
    }
    device_.vk.vkCmdEndRendering(commands);
  }

  template <class AnyCommand>
  void bind(VkCommandBuffer commands, VkPipelineBindPoint point, const AnyCommand& command) {
    descriptors_.bind(commands, point, job_.programs[static_cast<std::size_t>(command.program)],
                      pipelines_.program(command.program), command.resources, resources_);
  }

  void begin_rendering(VkCommandBuffer commands, const Draw& draw) {
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const int target : draw.color_targets) colors.push_back(color_attachment(draw, target));
    const VkRenderingAttachmentInfo depth =
        draw.depth_target < 0 ? VkRenderingAttachmentInfo{} : depth_attachment(draw);
    const VkExtent2D extent = target_extent(draw);
    const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = {.extent = extent},
                                  .layerCount = 1,
                                  .colorAttachmentCount = static_cast<std::uint32_t>(colors.size()),
                                  .pColorAttachments = colors.data(),
                                  .pDepthAttachment = draw.depth_target < 0 ? nullptr : &depth};
    device_.vk.vkCmdBeginRendering(commands, &info);
    const VkViewport viewport = {.width = static_cast<float>(extent.width),
                                 .height = static_cast<float>(extent.height),
                                 .minDepth = 0,
                                 .maxDepth = 1};
    const VkRect2D scissor = {.extent = extent};
    device_.vk.vkCmdSetViewport(commands, 0, 1, &viewport);
    device_.vk.vkCmdSetScissor(commands, 0, 1, &scissor);
  }

  VkRenderingAttachmentInfo attachment(int target, bool clear) {
    const DeviceImage& image = resources_.image(target);
    return {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = image.base_level.get(),
            .imageLayout = image.layout,
            .loadOp = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD,
            .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  }

  VkRenderingAttachmentInfo color_attachment(const Draw& draw, int target) {
    VkRenderingAttachmentInfo info = attachment(target, draw.clear_color.has_value());
    const std::array<float, 4> color = draw.clear_color.value_or(std::array<float, 4>{});
    VkClearColorValue& value = info.clearValue.color;
    if (is_integer(texture(target).format)) {
      const auto whole = [](float c) { return static_cast<std::uint32_t>(std::clamp(double{c}, 0.0, 4294967295.0)); };
      std::transform(color.begin(), color.end(), value.uint32, whole);
    } else {
      std::copy(color.begin(), color.end(), value.float32);
    }
    return info;
  }

  VkRenderingAttachmentInfo depth_attachment(const Draw& draw) {
    VkRenderingAttachmentInfo info = attachment(draw.depth_target, draw.clear_depth.has_value());
    info.clearValue.depthStencil.depth = draw.clear_depth.value_or(0);
    return info;
  }

  VkExtent2D target_extent(const Draw& draw) const {
    const Texture& target = texture(draw.color_targets.empty() ? draw.depth_target : draw.color_targets.front());
    return {static_cast<std::uint32_t>(target.width), static_cast<std::uint32_t>(target.height)};
  }

  std::vector<Resources::Transition> transitions(const Dispatch& dispatch) const {
    return texture_transitions(dispatch.program, dispatch.resources);
  }

  std::vector<Resources::Transition> transitions(const Draw& draw) const {
    auto list = texture_transitions(draw.program, draw.resources);
    for (const int target : draw.color_targets) list.push_back({target, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
    if (draw.depth_target >= 0) list.push_back({draw.depth_target, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL});
    return list;
  }

  /// The layouts in which a command reads and stores textures; one that it both samples and stores is in the general
  /// layout for both.
  std::vector<Resources::Transition> texture_transitions(int program,
                                                         const std::vector<ResourceBinding>& bindings) const {
    std::vector<Resources::Transition> list;
    for (const ResourceBinding& binding : bindings) {
      const ResourceKind kind = kind_of(program, binding);
      if (kind == ResourceKind::storage_texture) list.push_back({binding.resource, VK_IMAGE_LAYOUT_GENERAL});
      if (kind != ResourceKind::sampled_texture) continue;
      const bool is_stored = std::any_of(bindings.begin(), bindings.end(), [&](const ResourceBinding& other) {
        return other.resource == binding.resource && kind_of(program, other) == ResourceKind::storage_texture;
      });
      list.push_back(
          {binding.resource, is_stored ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    return list;
  }

  ResourceKind kind_of(int program, const ResourceBinding& binding) const {
    return slot_of(job_.programs[static_cast<std::size_t>(program)], binding).kind;
  }

  const Texture& texture(int index) const { return job_.textures[static_cast<std::size_t>(index)]; }

  Device& device_;
  const Job& job_;
  Resources resources_;
  Pipelines pipelines_;
  Descriptors descriptors_;
  Timestamps timestamps_;
};

}  // namespace

JobResult run_job(Device& device, const Job& job, VkPipelineCache cache, RecentPrograms<DeviceProgram>& recent,
                  const std::function<void()>& uploaded, const TakeReadBack& take) {
  return Execution(device, job, cache, recent).run(uploaded, take);
}

}  // namespace relievo::vulkan
