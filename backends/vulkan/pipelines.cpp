#include "pipelines.hpp"

#include <algorithm>
#include <array>

#include "formats.hpp"
#include "programs.hpp"

namespace relievo::vulkan {

namespace {

std::vector<VkPipelineShaderStageCreateInfo> stage_infos(const ShaderProgram& program, const DeviceProgram& loaded,
                                                         const Specialization& constants) {
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  for (std::size_t i = 0; i < program.shaders.size(); ++i) {
    stages.push_back({.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                      .stage = stage_flag(program.shaders[i].stage),
                      .module = loaded.modules[i].get(),
                      .pName = "main",
                      .pSpecializationInfo = constants.info()});
  }
  return stages;
}

bool tessellates(const ShaderProgram& program) {
  return std::any_of(program.shaders.begin(), program.shaders.end(),
                     [](const ShaderCode& shader) { return shader.stage == ShaderStage::tessellation_evaluation; });
}

VkCullModeFlags cull_flags(CullMode cull) {
  switch (cull) {
    case CullMode::back:
      return VK_CULL_MODE_BACK_BIT;
    case CullMode::front:
      return VK_CULL_MODE_FRONT_BIT;
    case CullMode::none:
      break;
  }
  return VK_CULL_MODE_NONE;
}

/// The vertex buffer's layout; the info points into the lists.
struct VertexInput {
  explicit VertexInput(const Draw& draw) {
    for (const VertexAttribute& attribute : draw.attributes) {
      attributes.push_back({.location = static_cast<std::uint32_t>(attribute.location),
                            .format = vertex_format(attribute.format),
                            .offset = static_cast<std::uint32_t>(attribute.offset)});
    }
    binding.stride = static_cast<std::uint32_t>(draw.vertex_stride);
    info.vertexBindingDescriptionCount = draw.attributes.empty() ? 0 : 1;
    info.pVertexBindingDescriptions = &binding;
    info.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes.size());
    info.pVertexAttributeDescriptions = attributes.data();
  }
  VertexInput(const VertexInput&) = delete;
  VertexInput& operator=(const VertexInput&) = delete;

  std::vector<VkVertexInputAttributeDescription> attributes;
  VkVertexInputBindingDescription binding = {.inputRate = VK_VERTEX_INPUT_RATE_VERTEX};
  VkPipelineVertexInputStateCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
};

bool same_attributes(const Draw& a, const Draw& b) {
  return a.vertex_stride == b.vertex_stride &&
         std::equal(a.attributes.begin(), a.attributes.end(), b.attributes.begin(), b.attributes.end(),
                    [](const VertexAttribute& x, const VertexAttribute& y) {
                      return x.location == y.location && x.format == y.format && x.offset == y.offset;
                    });
}

}  // namespace

Pipelines::Pipelines(const Device& device, const Job& job, VkPipelineCache cache)
    : device_(device), job_(job), cache_(cache) {
  for (const ShaderProgram& program : job.programs) programs_.push_back(load_program(device, program));
}

VkPipeline Pipelines::compute(int program) {
  const auto found = std::find_if(compute_.begin(), compute_.end(), [&](const auto& e) { return e.first == program; });
  if (found != compute_.end()) return found->second.get();
  return compute_.emplace_back(program, make_compute(program)).second.get();
}

VkPipeline Pipelines::graphics(const Draw& draw) {
  const auto found = std::find_if(graphics_.begin(), graphics_.end(),
                                  [&](const auto& entry) { return same_pipeline(*entry.first, draw); });
  if (found != graphics_.end()) return found->second.get();
  return graphics_.emplace_back(&draw, make_graphics(draw)).second.get();
}

std::vector<VkFormat> Pipelines::color_formats(const Draw& draw) const {
  std::vector<VkFormat> formats;
  for (const int target : draw.color_targets) {
    formats.push_back(image_format(job_.textures[static_cast<std::size_t>(target)].format));
  }
  return formats;
}

bool Pipelines::same_pipeline(const Draw& a, const Draw& b) const {
  return a.program == b.program && a.cull == b.cull && (a.depth_target < 0) == (b.depth_target < 0) &&
         color_formats(a) == color_formats(b) && same_attributes(a, b);
}

Unique<VkPipeline> Pipelines::make_compute(int index) const {
  const ShaderProgram& source = job_.programs[static_cast<std::size_t>(index)];
  const Specialization constants(source);
  const VkComputePipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                            .stage = stage_infos(source, program(index), constants).front(),
                                            .layout = program(index).layout.get()};
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(device_.vk.vkCreateComputePipelines(device_.handle(), cache_, 1, &info, nullptr, &pipeline),
        fmt::format("compiling program \"{}\"", source.name));
  return device_.own(pipeline, device_.vk.vkDestroyPipeline);
}

Unique<VkPipeline> Pipelines::make_graphics(const Draw& draw) const {
  const ShaderProgram& source = job_.programs[static_cast<std::size_t>(draw.program)];
  const Specialization constants(source);
  const auto stages = stage_infos(source, program(draw.program), constants);
  const VertexInput vertex_input(draw);
  const VkPipelineInputAssemblyStateCreateInfo assembly = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = tessellates(source) ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  const VkPipelineTessellationStateCreateInfo tessellation = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO, .patchControlPoints = 3};
  const VkPipelineViewportStateCreateInfo viewport = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  // Vulkan's counter-clockwise is as seen with row 0 at the top, as the Job's.
  const VkPipelineRasterizationStateCreateInfo rasterization = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .polygonMode = VK_POLYGON_MODE_FILL,
      .cullMode = cull_flags(draw.cull),
      .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
      .lineWidth = 1};
  const VkPipelineMultisampleStateCreateInfo multisample = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const bool has_depth = draw.depth_target >= 0;
  const VkPipelineDepthStencilStateCreateInfo depth = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
      .depthTestEnable = has_depth,
      .depthWriteEnable = has_depth,
      .depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL};
  const std::vector<VkFormat> formats = color_formats(draw);
  const std::vector<VkPipelineColorBlendAttachmentState> attachments(formats.size(), {.colorWriteMask = 0xf});
  const VkPipelineColorBlendStateCreateInfo blend = {.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                     .attachmentCount = static_cast<std::uint32_t>(attachments.size()),
                                                     .pAttachments = attachments.data()};
  constexpr std::array<VkDynamicState, 2> dynamic_states = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic = {.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                    .dynamicStateCount = dynamic_states.size(),
                                                    .pDynamicStates = dynamic_states.data()};
  const VkPipelineRenderingCreateInfo rendering = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
      .colorAttachmentCount = static_cast<std::uint32_t>(formats.size()),
      .pColorAttachmentFormats = formats.data(),
      .depthAttachmentFormat = has_depth ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED};
  const VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                             .pNext = &rendering,
                                             .stageCount = static_cast<std::uint32_t>(stages.size()),
                                             .pStages = stages.data(),
                                             .pVertexInputState = &vertex_input.info,
                                             .pInputAssemblyState = &assembly,
                                             .pTessellationState = &tessellation,
                                             .pViewportState = &viewport,
                                             .pRasterizationState = &rasterization,
                                             .pMultisampleState = &multisample,
                                             .pDepthStencilState = &depth,
                                             .pColorBlendState = &blend,
                                             .pDynamicState = &dynamic,
                                             .layout = program(draw.program).layout.get()};
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(device_.vk.vkCreateGraphicsPipelines(device_.handle(), cache_, 1, &info, nullptr, &pipeline),
        fmt::format("compiling program \"{}\"", source.name));
  return device_.own(pipeline, device_.vk.vkDestroyPipeline);
}

}  // namespace relievo::vulkan
