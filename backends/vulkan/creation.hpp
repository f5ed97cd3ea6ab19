/// Creating buffers and images.
#pragma once

#include "device.hpp"
#include "relievo/job.hpp"
#include "resources.hpp"

namespace relievo::vulkan {

DeviceBuffer create_buffer(const Device& device, const Buffer& buffer);
HostBuffer create_host_buffer(const Device& device, std::size_t size, VkMemoryPropertyFlags preferred);

/// How the job's commands use each texture.
std::vector<VkImageUsageFlags> texture_usages(const Job& job);
DeviceImage create_image(const Device& device, const Texture& texture, VkImageUsageFlags usage);

VkExtent3D level_extent(const Texture& texture, int level);

/// Of an array; 1 for other textures.
std::uint32_t layer_count(const Texture& texture);

}  // namespace relievo::vulkan
