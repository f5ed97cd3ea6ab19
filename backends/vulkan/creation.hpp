/// Creating buffers and images.
#pragma once

#include "device.hpp"
#include "relievo/job.hpp"
#include "resources.hpp"

namespace relievo::vulkan {

/// Where host and device share their memory (integrated and software devices), the host sees the buffer.
DeviceBuffer create_buffer(const Device& device, const Buffer& buffer);
/// A buffer to copy from or to, which the host sees.
DeviceBuffer create_host_buffer(const Device& device, std::size_t size, VkMemoryPropertyFlags preferred);

/// How the job's commands use each texture.
std::vector<VkImageUsageFlags> texture_usages(const Job& job);
DeviceImage create_image(const Device& device, const Texture& texture, VkImageUsageFlags usage);

VkExtent3D level_extent(const Texture& texture, int level);

/// Of an array; 1 for other textures.
std::uint32_t layer_count(const Texture& texture);

}  // namespace relievo::vulkan
