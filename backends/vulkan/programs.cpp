#include "programs.hpp"

#include <algorithm>
#include <spirv-tools/libspirv.hpp>

namespace relievo::vulkan {

namespace {

void check_stage(const Device& device, const ShaderProgram& program, ShaderStage stage) {
  const VkPhysicalDeviceFeatures& features = device.traits().features;
  const bool tessellates = stage == ShaderStage::tessellation_control || stage == ShaderStage::tessellation_evaluation;
  if ((stage == ShaderStage::geometry && !features.geometryShader) || (tessellates && !features.tessellationShader)) {
    refuse(ErrorCode::unsupported, "backend.feature", "Program \"{}\" has a {} shader, which the device does not offer",
           program.name, to_string(stage));
  }
}

/// Drivers trust SPIR-V and may crash on what is not valid.
void check_spirv(const ShaderProgram& program, const ShaderCode& shader) {
  std::string problem = "there is none";
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  tools.SetMessageConsumer(
      [&](spv_message_level_t, const char*, const spv_position_t&, const char* message) { problem = message; });
  if (!shader.spirv.empty() && tools.Validate(shader.spirv)) return;
  refuse(ErrorCode::backend, "backend.spirv", "Program \"{}\" has no valid SPIR-V in its {} shader: {}", program.name,
         to_string(shader.stage), problem);
}

Unique<VkShaderModule> load_shader(const Device& device, const ShaderProgram& program, const ShaderCode& shader) {
  check_stage(device, program, shader.stage);
  check_spirv(program, shader);
  const VkShaderModuleCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                         .codeSize = shader.spirv.size() * sizeof(std::uint32_t),
                                         .pCode = shader.spirv.data()};
  return device.create(device.vk.vkCreateShaderModule, device.vk.vkDestroyShaderModule, info,
                       fmt::format("loading the {} shader of program \"{}\"", to_string(shader.stage), program.name));
}

Unique<VkDescriptorSetLayout> make_set_layout(const Device& device, const ShaderProgram& program, int set) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const BindingSlot& slot : program.bindings) {
    if (slot.set != set) continue;
    bindings.push_back({.binding = static_cast<std::uint32_t>(slot.binding),
                        .descriptorType = descriptor_type(slot.kind),
                        .descriptorCount = 1,
                        .stageFlags = VK_SHADER_STAGE_ALL});
  }
  const VkDescriptorSetLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                                .pBindings = bindings.data()};
  return device.create(device.vk.vkCreateDescriptorSetLayout, device.vk.vkDestroyDescriptorSetLayout, info,
                       fmt::format("creating set layout {} of program \"{}\"", set, program.name));
}

void make_layouts(const Device& device, const ShaderProgram& program, DeviceProgram& made) {
  int last_set = -1;
  for (const BindingSlot& slot : program.bindings) last_set = std::max(last_set, slot.set);
  if (last_set >= static_cast<int>(device.limits().maxBoundDescriptorSets)) {
    refuse(ErrorCode::unsupported, "backend.limit", "Program \"{}\" uses set {}, the device has sets 0..{}",
           program.name, last_set, device.limits().maxBoundDescriptorSets - 1);
  }
  std::vector<VkDescriptorSetLayout> handles;
  for (int set = 0; set <= last_set; ++set) {
    made.set_layouts.push_back(make_set_layout(device, program, set));
    handles.push_back(made.set_layouts.back().get());
  }
  const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                           .setLayoutCount = static_cast<std::uint32_t>(handles.size()),
                                           .pSetLayouts = handles.data()};
  made.layout = device.create(device.vk.vkCreatePipelineLayout, device.vk.vkDestroyPipelineLayout, info,
                              fmt::format("creating the layout of program \"{}\"", program.name));
}

}  // namespace

VkShaderStageFlagBits stage_flag(ShaderStage stage) {
  switch (stage) {
    case ShaderStage::vertex:
      return VK_SHADER_STAGE_VERTEX_BIT;
    case ShaderStage::tessellation_control:
      return VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT;
    case ShaderStage::tessellation_evaluation:
      return VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT;
    case ShaderStage::geometry:
      return VK_SHADER_STAGE_GEOMETRY_BIT;
    case ShaderStage::fragment:
      return VK_SHADER_STAGE_FRAGMENT_BIT;
    case ShaderStage::compute:
      break;
  }
  return VK_SHADER_STAGE_COMPUTE_BIT;
}

VkDescriptorType descriptor_type(ResourceKind kind) {
  switch (kind) {
    case ResourceKind::uniform_buffer:
      return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case ResourceKind::storage_buffer:
      return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    case ResourceKind::sampled_texture:
      return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    case ResourceKind::storage_texture:
      break;
  }
  return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
}

DeviceProgram load_program(const Device& device, const ShaderProgram& program) {
  DeviceProgram made;
  for (const ShaderCode& shader : program.shaders) made.modules.push_back(load_shader(device, program, shader));
  make_layouts(device, program, made);
  return made;
}

Specialization::Specialization(const ShaderProgram& program) : info_() {
  for (std::size_t i = 0; i < program.constants.size(); ++i) {
    const std::size_t offset = i * sizeof(SpecializationValue) + offsetof(SpecializationValue, bits);
    entries_.push_back({.constantID = program.constants[i].id,
                        .offset = static_cast<std::uint32_t>(offset),
                        .size = sizeof(SpecializationValue::bits)});
  }
  info_.mapEntryCount = static_cast<std::uint32_t>(entries_.size());
  info_.pMapEntries = entries_.data();
  info_.dataSize = program.constants.size() * sizeof(SpecializationValue);
  info_.pData = program.constants.data();
}

}  // namespace relievo::vulkan
