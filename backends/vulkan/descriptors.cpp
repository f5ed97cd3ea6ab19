#include "descriptors.hpp"

#include <algorithm>
#include <map>

#include "programs.hpp"

namespace relievo::vulkan {

namespace {

void check_range(const Device& device, const BindingSlot& slot, const Buffer& buffer) {
  const bool is_uniform = slot.kind == ResourceKind::uniform_buffer;
  const std::size_t limit = is_uniform ? device.limits().maxUniformBufferRange : device.limits().maxStorageBufferRange;
  if (buffer.size <= limit) return;
  refuse(ErrorCode::unsupported, "backend.limit", "Buffer \"{}\" has {} bytes, the device binds up to {} as a {}",
         buffer.name, buffer.size, limit, to_string(slot.kind));
}

}  // namespace

const BindingSlot& slot_of(const ShaderProgram& program, const ResourceBinding& binding) {
  return *std::find_if(program.bindings.begin(), program.bindings.end(), [&](const BindingSlot& slot) {
    return slot.set == binding.set && slot.binding == binding.binding;
  });
}

Descriptors::Descriptors(const Device& device, const Job& job) : device_(device), job_(job) {
  std::map<VkDescriptorType, std::uint32_t> counts;
  std::uint32_t sets = 0;
  for (const Command& command : job.commands) {
    const int index = std::visit([](const auto& c) { return c.program; }, command);
    int last_set = -1;
    for (const BindingSlot& slot : job.programs[static_cast<std::size_t>(index)].bindings) {
      ++counts[descriptor_type(slot.kind)];
      last_set = std::max(last_set, slot.set);
    }
    sets += static_cast<std::uint32_t>(last_set + 1);
  }
  if (counts.empty()) return;
  std::vector<VkDescriptorPoolSize> sizes;
  for (const auto& [type, count] : counts) sizes.push_back({type, count});
  const VkDescriptorPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                           .maxSets = sets,
                                           .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                           .pPoolSizes = sizes.data()};
  pool_ = device.create(device.vk.vkCreateDescriptorPool, device.vk.vkDestroyDescriptorPool, info,
                        "creating the descriptor pool");
}

std::vector<VkDescriptorSet> Descriptors::allocate(const DeviceProgram& loaded) {
  std::vector<VkDescriptorSetLayout> layouts;
  for (const auto& layout : loaded.set_layouts) layouts.push_back(layout.get());
  const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = pool_.get(),
                                            .descriptorSetCount = static_cast<std::uint32_t>(layouts.size()),
                                            .pSetLayouts = layouts.data()};
  std::vector<VkDescriptorSet> sets(layouts.size());
  check(device_.vk.vkAllocateDescriptorSets(device_.handle(), &info, sets.data()), "allocating descriptor sets");
  return sets;
}

void Descriptors::write(VkDescriptorSet set, const BindingSlot& slot, int resource, Resources& resources) {
  VkDescriptorBufferInfo buffer = {};
  VkDescriptorImageInfo texture = {};
  if (slot.kind == ResourceKind::uniform_buffer || slot.kind == ResourceKind::storage_buffer) {
    const Buffer& source = job_.buffers[static_cast<std::size_t>(resource)];
    check_range(device_, slot, source);
    buffer = {.buffer = resources.buffer(resource), .range = source.size};
  } else {
    const DeviceImage& image = resources.image(resource);
    const bool is_stored = slot.kind == ResourceKind::storage_texture;
    texture = {.sampler = is_stored ? VK_NULL_HANDLE : image.sampler.get(),
               .imageView = is_stored ? image.base_level.get() : image.all_levels.get(),
               .imageLayout = image.layout};
  }
  const VkWriteDescriptorSet info = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = set,
                                     .dstBinding = static_cast<std::uint32_t>(slot.binding),
                                     .descriptorCount = 1,
                                     .descriptorType = descriptor_type(slot.kind),
                                     .pImageInfo = &texture,
                                     .pBufferInfo = &buffer};
  device_.vk.vkUpdateDescriptorSets(device_.handle(), 1, &info, 0, nullptr);
}

void Descriptors::bind(VkCommandBuffer commands, VkPipelineBindPoint point, const ShaderProgram& program,
                       const DeviceProgram& loaded, const std::vector<ResourceBinding>& bindings,
                       Resources& resources) {
  if (bindings.empty()) return;
  const std::vector<VkDescriptorSet> sets = allocate(loaded);
  for (const ResourceBinding& binding : bindings) {
    write(sets[static_cast<std::size_t>(binding.set)], slot_of(program, binding), binding.resource, resources);
  }
  device_.vk.vkCmdBindDescriptorSets(commands, point, loaded.layout.get(), 0, static_cast<std::uint32_t>(sets.size()),
                                     sets.data(), 0, nullptr);
}

}  // namespace relievo::vulkan
