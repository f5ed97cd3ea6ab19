/// A Job of the SDK drawn by an application that has its own Vulkan: instance, device, memory and command buffer.
/// Nothing of the SDK's backends draws here; one only bakes the maps that the technique reads.
///
/// Of a Job it takes one indexed Draw that clears its targets, with a vertex and a fragment shader, uniform buffers and
/// sampled textures. It refuses dispatches, several commands, other shaders, storage buffers and textures,
/// specialization constants, three-channel textures, and read-backs other than one colour target.
#include <algorithm>
#include <cstdio>

#include "relievo/image.hpp"
#include "relievo/render.hpp"
#include "resources.hpp"

namespace {

using relievo::Draw;
using relievo::Job;

// what of a Job it takes

const Draw& only_draw(const Job& job) {
  const Draw* draw = job.commands.size() == 1 ? std::get_if<Draw>(&job.commands[0]) : nullptr;
  if (!draw) refuse("'" + job.name + "' has dispatches or several commands; expected one Draw");
  if (draw->index_buffer < 0 || !draw->clear_color || (draw->depth_target >= 0 && !draw->clear_depth))
    refuse("the Draw has no indices or keeps what was in its targets; expected an indexed one that clears them");
  const relievo::ShaderProgram& program = job.programs[draw->program];
  if (!program.constants.empty()) refuse("program '" + program.name + "' has specialization constants; expected none");
  for (const relievo::ShaderCode& shader : program.shaders) {
    if (shader.stage != relievo::ShaderStage::vertex && shader.stage != relievo::ShaderStage::fragment)
      refuse("program '" + program.name + "' has a " + std::string(to_string(shader.stage)) + " shader");
  }
  const bool one_target = draw->color_targets.size() == 1 && job.read_backs.size() == 1 &&
                          job.read_backs[0].source == relievo::ReadBack::Source::texture &&
                          job.read_backs[0].index == draw->color_targets[0] && job.read_backs[0].level == 0;
  if (!one_target) refuse("it reads back something else than its one colour target");
  return *draw;
}

// the program and its bindings

VkDescriptorType descriptor_type(relievo::ResourceKind kind) {
  if (kind == relievo::ResourceKind::uniform_buffer) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  if (kind == relievo::ResourceKind::sampled_texture) return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  refuse("a program has a " + std::string(to_string(kind)));
}

struct Layout {
  std::vector<VkDescriptorSetLayout> sets;
  VkPipelineLayout pipeline = VK_NULL_HANDLE;
};

Layout make_layout(Vulkan& vulkan, const relievo::ShaderProgram& program) {
  int sets = 0;
  for (const relievo::BindingSlot& slot : program.bindings) sets = std::max(sets, slot.set + 1);
  Layout made;
  for (int set = 0; set < sets; ++set) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const relievo::BindingSlot& slot : program.bindings) {
      if (slot.set != set) continue;
      bindings.push_back({static_cast<std::uint32_t>(slot.binding), descriptor_type(slot.kind), 1,
                          VK_SHADER_STAGE_ALL_GRAPHICS, nullptr});
    }
    const VkDescriptorSetLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                  .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                                  .pBindings = bindings.data()};
    made.sets.push_back(vulkan.make(vkCreateDescriptorSetLayout, vkDestroyDescriptorSetLayout, info));
  }
  const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                           .setLayoutCount = static_cast<std::uint32_t>(made.sets.size()),
                                           .pSetLayouts = made.sets.data()};
  made.pipeline = vulkan.make(vkCreatePipelineLayout, vkDestroyPipelineLayout, info);
  return made;
}

std::vector<VkDescriptorSet> make_sets(Vulkan& vulkan, const Layout& layout) {
  constexpr std::uint32_t many = 64;
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, many},
                                        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, many}};
  const VkDescriptorPoolCreateInfo pool = {
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = many, .poolSizeCount = 2, .pPoolSizes = sizes};
  std::vector<VkDescriptorSet> sets(layout.sets.size());
  const VkDescriptorSetAllocateInfo info = {
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
      .descriptorPool = vulkan.make(vkCreateDescriptorPool, vkDestroyDescriptorPool, pool),
      .descriptorSetCount = static_cast<std::uint32_t>(sets.size()),
      .pSetLayouts = layout.sets.data()};
  check(vkAllocateDescriptorSets(vulkan.device, &info, sets.data()), "allocating descriptor sets");
  return sets;
}

/// Connects each slot of the program's contract to the buffer or texture that the Draw names for it.
std::vector<VkDescriptorSet> bind(Vulkan& vulkan, const Job& job, const Draw& draw, const Layout& layout,
                                  const Resources& resources) {
  const std::vector<VkDescriptorSet> sets = make_sets(vulkan, layout);
  for (const relievo::BindingSlot& slot : job.programs[draw.program].bindings) {
    const auto bound = std::find_if(draw.resources.begin(), draw.resources.end(), [&](const auto& resource) {
      return resource.set == slot.set && resource.binding == slot.binding;
    });  // validate_job has seen that each slot is bound
    VkDescriptorBufferInfo buffer = {.range = VK_WHOLE_SIZE};
    VkDescriptorImageInfo image = {.imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    if (slot.kind == relievo::ResourceKind::uniform_buffer) {
      buffer.buffer = resources.buffers[bound->resource].buffer;
    } else {
      image.imageView = resources.images[bound->resource].view;
      image.sampler = resources.images[bound->resource].sampler;
    }
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = sets[slot.set],
                                        .dstBinding = static_cast<std::uint32_t>(slot.binding),
                                        .descriptorCount = 1,
                                        .descriptorType = descriptor_type(slot.kind),
                                        .pImageInfo = &image,
                                        .pBufferInfo = &buffer};
    vkUpdateDescriptorSets(vulkan.device, 1, &write, 0, nullptr);
  }
  return sets;
}

std::vector<VkPipelineShaderStageCreateInfo> make_stages(Vulkan& vulkan, const relievo::ShaderProgram& program) {
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  for (const relievo::ShaderCode& shader : program.shaders) {
    const VkShaderModuleCreateInfo module = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                             .codeSize = shader.spirv.size() * sizeof(std::uint32_t),
                                             .pCode = shader.spirv.data()};
    const bool is_vertex = shader.stage == relievo::ShaderStage::vertex;
    stages.push_back({.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                      .stage = is_vertex ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT,
                      .module = vulkan.make(vkCreateShaderModule, vkDestroyShaderModule, module),
                      .pName = "main"});
  }
  return stages;
}

VkPipeline make_pipeline(Vulkan& vulkan, const Job& job, const Draw& draw, VkPipelineLayout layout) {
  const auto stages = make_stages(vulkan, job.programs[draw.program]);
  const VkVertexInputBindingDescription vertices = {.stride = static_cast<std::uint32_t>(draw.vertex_stride)};
  std::vector<VkVertexInputAttributeDescription> attributes;
  for (const relievo::VertexAttribute& attribute : draw.attributes) {
    attributes.push_back({static_cast<std::uint32_t>(attribute.location), 0, to_vulkan(attribute.format),
                          static_cast<std::uint32_t>(attribute.offset)});
  }
  const VkPipelineVertexInputStateCreateInfo input = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
      .vertexBindingDescriptionCount = 1,
      .pVertexBindingDescriptions = &vertices,
      .vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes.size()),
      .pVertexAttributeDescriptions = attributes.data()};
  const VkPipelineInputAssemblyStateCreateInfo assembly = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  const VkRect2D area = {
      {},
      {extent(job.textures[draw.color_targets[0]], 0).width, extent(job.textures[draw.color_targets[0]], 0).height}};
  const VkViewport whole = {0, 0, static_cast<float>(area.extent.width), static_cast<float>(area.extent.height), 0, 1};
  const VkPipelineViewportStateCreateInfo viewport = {.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                                                      .viewportCount = 1,
                                                      .pViewports = &whole,
                                                      .scissorCount = 1,
                                                      .pScissors = &area};
  // Row 0 of a target is NDC y = -1, so that Vulkan's own viewport, winding and depth are the Job's.
  const VkPipelineRasterizationStateCreateInfo raster = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .cullMode = draw.cull == relievo::CullMode::none   ? VK_CULL_MODE_NONE
                  : draw.cull == relievo::CullMode::back ? VK_CULL_MODE_BACK_BIT
                                                         : VK_CULL_MODE_FRONT_BIT,
      .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
      .lineWidth = 1};
  const VkPipelineMultisampleStateCreateInfo samples = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const bool has_depth = draw.depth_target >= 0;
  const VkPipelineDepthStencilStateCreateInfo depth = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
      .depthTestEnable = has_depth,
      .depthWriteEnable = has_depth,
      .depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL};
  const VkPipelineColorBlendAttachmentState opaque = {.colorWriteMask = 0xf};
  const VkPipelineColorBlendStateCreateInfo blend = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO, .attachmentCount = 1, .pAttachments = &opaque};
  const VkFormat color = to_vulkan(job.textures[draw.color_targets[0]].format);
  const VkPipelineRenderingCreateInfo targets = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
      .colorAttachmentCount = 1,
      .pColorAttachmentFormats = &color,
      .depthAttachmentFormat = has_depth ? to_vulkan(job.textures[draw.depth_target].format) : VK_FORMAT_UNDEFINED};
  const VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                             .pNext = &targets,
                                             .stageCount = static_cast<std::uint32_t>(stages.size()),
                                             .pStages = stages.data(),
                                             .pVertexInputState = &input,
                                             .pInputAssemblyState = &assembly,
                                             .pViewportState = &viewport,
                                             .pRasterizationState = &raster,
                                             .pMultisampleState = &samples,
                                             .pDepthStencilState = &depth,
                                             .pColorBlendState = &blend,
                                             .layout = layout};
  return vulkan.make_pipeline(info);
}

// the Draw

VkRenderingAttachmentInfo cleared(VkImageView view, const VkClearValue& value) {
  return {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
          .imageView = view,
          .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
          .clearValue = value};
}

void begin_pass(Vulkan& vulkan, const Job& job, const Draw& draw, const Resources& resources) {
  VkClearValue color = {};
  std::copy(draw.clear_color->begin(), draw.clear_color->end(), color.color.float32);
  const VkRenderingAttachmentInfo target = cleared(resources.images[draw.color_targets[0]].view, color);
  VkRenderingAttachmentInfo depth = {};
  if (draw.depth_target >= 0)
    depth = cleared(resources.images[draw.depth_target].view, {.depthStencil = {*draw.clear_depth, 0}});
  const VkExtent3D size = extent(job.textures[draw.color_targets[0]], 0);
  const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                .renderArea = {{}, {size.width, size.height}},
                                .layerCount = 1,
                                .colorAttachmentCount = 1,
                                .pColorAttachments = &target,
                                .pDepthAttachment = draw.depth_target >= 0 ? &depth : nullptr};
  vkCmdBeginRendering(vulkan.commands, &info);
}

void record(Vulkan& vulkan, const Job& job, const Draw& draw, const Resources& resources) {
  const Layout layout = make_layout(vulkan, job.programs[draw.program]);
  const std::vector<VkDescriptorSet> sets = bind(vulkan, job, draw, layout, resources);
  const VkPipeline pipeline = make_pipeline(vulkan, job, draw, layout.pipeline);
  const VkDeviceSize start = 0;
  begin_pass(vulkan, job, draw, resources);
  vkCmdBindPipeline(vulkan.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  vkCmdBindDescriptorSets(vulkan.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout.pipeline, 0,
                          static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
  vkCmdBindVertexBuffers(vulkan.commands, 0, 1, &resources.buffers[draw.vertex_buffer].buffer, &start);
  vkCmdBindIndexBuffer(vulkan.commands, resources.buffers[draw.index_buffer].buffer, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(vulkan.commands, draw.count, draw.instances, 0, 0, 0);
  vkCmdEndRendering(vulkan.commands);
  barrier(vulkan);
}

/// The pixels of the job's one read-back, row 0 first.
std::vector<std::uint8_t> run(const Job& job) {
  const Draw& draw = only_draw(job);
  Vulkan vulkan;
  const Resources resources = upload(vulkan, job);
  record(vulkan, job, draw, resources);
  const int target = job.read_backs[0].index;
  const relievo::Texture& texture = job.textures[target];
  const HostBuffer pixels = make_buffer(vulkan, relievo::level_size(texture, 0), {});
  const VkBufferImageCopy copy = copy_of(texture, 0);
  vkCmdCopyImageToBuffer(vulkan.commands, resources.images[target].image, VK_IMAGE_LAYOUT_GENERAL, pixels.buffer, 1,
                         &copy);
  barrier(vulkan);
  vulkan.submit_and_wait();
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(pixels.bytes);
  return {bytes, bytes + relievo::level_size(texture, 0)};
}

// the SDK's part: from a scene and a technique to a Job

template <class T>
T value_of(relievo::Result<T> result) {
  if (!result) throw std::runtime_error(relievo::format(result.error()));
  return std::move(*result);
}

Job make_job(const char* scene_file, const relievo::RenderRequest& request, relievo::Scene& scene) {
  const relievo::Registry registry = value_of(relievo::load_registry());
  scene = value_of(relievo::load_scene(scene_file));
  const relievo::Mesh mesh = value_of(relievo::scene_mesh(scene));
  relievo::MapSet maps = relievo::map_set(value_of(relievo::scene_height_map(scene)));
  const auto baker = value_of(relievo::open_backend("vulkan"));
  for (const std::string& map : value_of(relievo::required_maps(registry, request.stage, request.technique))) {
    if (auto status = relievo::bake_map(*baker, registry, map, maps); !status)
      throw std::runtime_error(relievo::format(status.error()));
  }
  return value_of(relievo::make_render_job(registry, scene, mesh, maps, request, "spirv"));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && argc != 5) {
    std::fprintf(stderr, "usage: minimal_vulkan SCENE.toml TECHNIQUE OUT.png [STAGE]\n");
    return 1;
  }
  try {
    relievo::RenderRequest request;
    request.technique = argv[2];
    request.stage = argc == 5 ? argv[4] : "surface";
    relievo::Scene scene;
    const std::vector<std::uint8_t> pixels = run(make_job(argv[1], request, scene));
    if (auto status = relievo::write_png(argv[3], scene.image.width, scene.image.height, 4, pixels); !status)
      throw std::runtime_error(relievo::format(status.error()));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
