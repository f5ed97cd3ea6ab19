/// The buffers and textures of a Job on the application's own device.
#pragma once

#include "relievo/job.hpp"
#include "vulkan.hpp"

/// Throws what of a Job this application does not take.
[[noreturn]] inline void refuse(const std::string& sentence) {
  throw std::runtime_error("minimal_vulkan takes less than every Job: " + sentence);
}

struct HostBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  std::byte* bytes = nullptr;
};

struct Image {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;
};

struct Resources {
  std::vector<HostBuffer> buffers;
  std::vector<Image> images;
};

/// `size` bytes that the host sees; those after `contents` are zero.
HostBuffer make_buffer(Vulkan& vulkan, std::size_t size, const std::vector<std::byte>& contents);

/// Makes everything and records the copies of its contents. Textures without contents are targets.
Resources upload(Vulkan& vulkan, const relievo::Job& job);

/// Everything before is done before anything after. Images stay in the one layout that is good for all uses.
void barrier(Vulkan& vulkan, const std::vector<VkImageMemoryBarrier2>& images = {});

VkFormat to_vulkan(relievo::Format format);
VkExtent3D extent(const relievo::Texture& texture, int level);
VkBufferImageCopy copy_of(const relievo::Texture& texture, int level);
