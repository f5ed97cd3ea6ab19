#include "creation.hpp"

#include <algorithm>
#include <span>

#include "formats.hpp"

namespace relievo::vulkan {

namespace {

constexpr VkImageUsageFlags transfers = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

bool is_3d(const Texture& texture) {
  return !texture.is_array && (texture.is_3d || texture.depth > 1);
}

VkImageViewType view_type(const Texture& texture) {
  if (texture.is_array) return VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  return is_3d(texture) ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D;
}

/// In memory of the first type that is as wished; the host sees it if its memory is all that `mapped` names.
DeviceBuffer make_buffer(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage,
                         std::span<const VkMemoryPropertyFlags> wishes, VkMemoryPropertyFlags mapped,
                         std::string_view what) {
  DeviceBuffer made;
  // Whole words, so that filling with zero reaches the last byte.
  const VkBufferCreateInfo info = {
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = (size + 3) / 4 * 4, .usage = usage};
  made.buffer = device.create(device.vk.vkCreateBuffer, device.vk.vkDestroyBuffer, info, what);
  VkMemoryRequirements requirements = {};
  device.vk.vkGetBufferMemoryRequirements(device.handle(), made.buffer.get(), &requirements);
  const std::uint32_t type = device.memory_type(requirements, wishes, what);
  made.memory = device.allocate(requirements, type, what);
  check(device.vk.vkBindBufferMemory(device.handle(), made.buffer.get(), made.memory.get(), 0), what);
  if (!has_all(device.traits().memory.memoryTypes[type].propertyFlags, mapped)) return made;
  void* bytes = nullptr;
  check(device.vk.vkMapMemory(device.handle(), made.memory.get(), 0, VK_WHOLE_SIZE, 0, &bytes), "mapping memory");
  made.bytes = static_cast<std::byte*>(bytes);
  return made;
}

VkSamplerAddressMode address_mode(TexelAddress address) {
  switch (address) {
    case TexelAddress::repeat:
      return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    case TexelAddress::mirror:
      return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case TexelAddress::clamp:
      break;
  }
  return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
}

Unique<VkSampler> create_sampler(const Device& device, const Texture& texture) {
  const SamplerState& state = texture.sampler;
  const bool linear = state.min_mag == TexelFilter::linear;
  const bool linear_mip = state.mip == TexelFilter::linear;
  const VkFormatFeatureFlags features = device.format_features(image_format(texture.format));
  if ((linear || linear_mip) && !(features & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT)) {
    refuse(ErrorCode::unsupported, "backend.filter",
           "The device cannot filter texture \"{}\" of format {} linearly, expected nearest", texture.name,
           to_string(texture.format));
  }
  const VkFilter filter = linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  const VkSamplerCreateInfo info = {
      .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
      .magFilter = filter,
      .minFilter = filter,
      .mipmapMode = linear_mip ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST,
      .addressModeU = address_mode(state.address[0]),
      .addressModeV = address_mode(state.address[1]),
      .addressModeW = address_mode(state.address[2]),
      .maxLod = VK_LOD_CLAMP_NONE};
  return device.create(device.vk.vkCreateSampler, device.vk.vkDestroySampler, info,
                       fmt::format("creating the sampler of texture \"{}\"", texture.name));
}

Unique<VkImageView> create_view(const Device& device, const Texture& texture, VkImage image, int levels) {
  const VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                      .image = image,
                                      .viewType = view_type(texture),
                                      .format = image_format(texture.format),
                                      .subresourceRange = {.aspectMask = aspect(texture.format),
                                                           .levelCount = static_cast<std::uint32_t>(levels),
                                                           .layerCount = layer_count(texture)}};
  return device.create(device.vk.vkCreateImageView, device.vk.vkDestroyImageView, info,
                       fmt::format("creating a view of texture \"{}\"", texture.name));
}

VkImageCreateInfo image_info(const Texture& texture, VkImageUsageFlags usage) {
  return {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
          .imageType = is_3d(texture) ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
          .format = image_format(texture.format),
          .extent = level_extent(texture, 0),
          .mipLevels = static_cast<std::uint32_t>(texture.levels),
          .arrayLayers = layer_count(texture),
          .samples = VK_SAMPLE_COUNT_1_BIT,
          .tiling = VK_IMAGE_TILING_OPTIMAL,
          .usage = usage};
}

void add_usages(std::vector<VkImageUsageFlags>& usages, const Job& job, int program,
                const std::vector<ResourceBinding>& resources) {
  const auto& slots = job.programs[static_cast<std::size_t>(program)].bindings;
  for (const ResourceBinding& binding : resources) {
    const auto slot = std::find_if(slots.begin(), slots.end(), [&](const BindingSlot& s) {
      return s.set == binding.set && s.binding == binding.binding;
    });
    const auto texture = static_cast<std::size_t>(binding.resource);
    if (slot->kind == ResourceKind::sampled_texture) usages[texture] |= VK_IMAGE_USAGE_SAMPLED_BIT;
    if (slot->kind == ResourceKind::storage_texture) usages[texture] |= VK_IMAGE_USAGE_STORAGE_BIT;
  }
}

void add_target_usages(std::vector<VkImageUsageFlags>& usages, const Draw& draw) {
  for (const int target : draw.color_targets) {
    usages[static_cast<std::size_t>(target)] |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  }
  if (draw.depth_target < 0) return;
  usages[static_cast<std::size_t>(draw.depth_target)] |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
}

}  // namespace

DeviceBuffer create_buffer(const Device& device, const Buffer& buffer) {
  constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                       VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                       VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
  const VkMemoryPropertyFlags wishes[] = {device.shared_memory(), VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  return make_buffer(device, buffer.size, usage, wishes, device.shared_memory(),
                     fmt::format("creating buffer \"{}\" of {} bytes", buffer.name, buffer.size));
}

DeviceBuffer create_host_buffer(const Device& device, std::size_t size, VkMemoryPropertyFlags preferred) {
  constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  const VkMemoryPropertyFlags wishes[] = {seen_by_host | preferred, seen_by_host};
  return make_buffer(device, size, usage, wishes, seen_by_host,
                     fmt::format("creating a buffer of {} bytes to copy", size));
}

std::vector<VkImageUsageFlags> texture_usages(const Job& job) {
  std::vector<VkImageUsageFlags> usages(job.textures.size(), transfers);
  for (const Command& command : job.commands) {
    std::visit([&](const auto& c) { add_usages(usages, job, c.program, c.resources); }, command);
    if (const Draw* draw = std::get_if<Draw>(&command)) add_target_usages(usages, *draw);
  }
  return usages;
}

VkExtent3D level_extent(const Texture& texture, int level) {
  const auto extent = [level](int size) { return static_cast<std::uint32_t>(std::max(1, size >> level)); };
  return {extent(texture.width), extent(texture.height), texture.is_array ? 1 : extent(texture.depth)};
}

std::uint32_t layer_count(const Texture& texture) {
  return texture.is_array ? static_cast<std::uint32_t>(texture.depth) : 1;
}

DeviceImage create_image(const Device& device, const Texture& texture, VkImageUsageFlags usage) {
  const std::string what = fmt::format("creating texture \"{}\"", texture.name);
  const VkImageCreateInfo info = image_info(texture, usage);
  device.check_image(info, texture.name);
  DeviceImage made;
  made.image = device.create(device.vk.vkCreateImage, device.vk.vkDestroyImage, info, what);
  VkMemoryRequirements requirements = {};
  device.vk.vkGetImageMemoryRequirements(device.handle(), made.image.get(), &requirements);
  constexpr VkMemoryPropertyFlags wishes[] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  made.memory = device.allocate(requirements, device.memory_type(requirements, wishes, what), what);
  check(device.vk.vkBindImageMemory(device.handle(), made.image.get(), made.memory.get(), 0), what);
  if (usage == transfers) return made;  // no command binds it, and a view of it would not be valid
  made.all_levels = create_view(device, texture, made.image.get(), texture.levels);
  made.base_level = create_view(device, texture, made.image.get(), 1);
  if (usage & VK_IMAGE_USAGE_SAMPLED_BIT) made.sampler = create_sampler(device, texture);
  return made;
}

}  // namespace relievo::vulkan
