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
  explicit VertexInput(const DrawState& state) {
    for (const VertexAttribute& attribute : state.attributes) {
      attributes.push_back({.location = static_cast<std::uint32_t>(attribute.location),
                            .format = vertex_format(attribute.format),
                            .offset = static_cast<std::uint32_t>(attribute.offset)});
    }
    binding.stride = static_cast<std::uint32_t>(state.vertex_stride);
    info.vertexBindingDescriptionCount = state.attributes.empty() ? 0 : 1;
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

}  // namespace

Pipelines::Pipelines(const Device& device, const Job& job, VkPipelineCache cache, RecentPrograms<DeviceProgram>& recent)
    : device_(device), job_(job), cache_(cache) {
  for (const ShaderProgram& source : job.programs) {
    auto kept = recent.find(source);
    programs_.push_back(kept ? std::move(kept) : recent.keep(source, load_program(device, source)));
  }
}

VkPipeline Pipelines::compute(int program) {
  Unique<VkPipeline>& pipeline = programs_[static_cast<std::size_t>(program)]->compute;
  if (!pipeline) pipeline = make_compute(program);
  return pipeline.get();
}

VkPipeline Pipelines::graphics(const Draw& draw) {
  auto& made = programs_[static_cast<std::size_t>(draw.program)]->graphics;
  DrawState state = state_of(draw);
  const auto found = std::find_if(made.begin(), made.end(), [&](const auto& entry) { return entry.first == state; });
  if (found != made.end()) return found->second.get();
  Unique<VkPipeline> pipeline = make_graphics(draw.program, state);
  return made.emplace_back(std::move(state), std::move(pipeline)).second.get();
}

DrawState Pipelines::state_of(const Draw& draw) const {
  DrawState state = {draw.cull, draw.depth_target >= 0, {}, draw.vertex_stride, draw.attributes};
  for (const int target : draw.color_targets) {
    state.color_formats.push_back(image_format(job_.textures[static_cast<std::size_t>(target)].format));
  }
  return state;
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

Unique<VkPipeline> Pipelines::make_graphics(int index, const DrawState& state) const {
  const ShaderProgram& source = job_.programs[static_cast<std::size_t>(index)];
  const Specialization constants(source);
  const auto stages = stage_infos(source, program(index), constants);
  const VertexInput vertex_input(state);
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
      .cullMode = cull_flags(state.cull),
      .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
      .lineWidth = 1};
  const VkPipelineMultisampleStateCreateInfo multisample = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const VkPipelineDepthStencilStateCreateInfo depth = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
      .depthTestEnable = state.has_depth,
      .depthWriteEnable = state.has_depth,
      .depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL};
  const std::vector<VkFormat>& formats = state.color_formats;
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
      .depthAttachmentFormat = state.has_depth ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED};
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
                                             .layout = program(index).layout.get()};
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(device_.vk.vkCreateGraphicsPipelines(device_.handle(), cache_, 1, &info, nullptr, &pipeline),
        fmt::format("compiling program \"{}\"", source.name));
  return device_.own(pipeline, device_.vk.vkDestroyPipeline);
}

}  // namespace relievo::vulkan
