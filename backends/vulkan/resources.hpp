/// A job's buffers and textures on the device.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "device.hpp"
#include "relievo/job.hpp"

namespace relievo::vulkan {

struct DeviceBuffer {
  Unique<VkDeviceMemory> memory;
  Unique<VkBuffer> buffer;
  std::byte* bytes = nullptr;  ///< as the host sees it, if it does; mapped as long as the buffer lives
};

struct DeviceImage {
  Unique<VkDeviceMemory> memory;
  Unique<VkImage> image;
  Unique<VkImageView> all_levels;  ///< what is sampled
  Unique<VkImageView> base_level;  ///< what is stored or drawn to
  Unique<VkSampler> sampler;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< after the commands recorded so far
};

class Resources {
 public:
  /// Creates everything; textures get the usages that the job's commands need.
  Resources(const Device& device, const Job& job);

  VkBuffer buffer(int index) const { return buffers_[static_cast<std::size_t>(index)].buffer.get(); }
  DeviceImage& image(int index) { return images_[static_cast<std::size_t>(index)]; }

  /// Makes or records the copies of all contents; what has none becomes zero, so that every run starts alike.
  void upload(VkCommandBuffer commands);
  /// Frees what these copies needed; they have run.
  void end_upload() { uploads_.clear(); }
  /// Records the copies of everything that is read back.
  void download(VkCommandBuffer commands);
  /// Hands over what was read back, once the commands have run. Frees the rest first: results may be large.
  void read_back(const TakeReadBack& take);

  /// Waits for everything before, and brings the image of texture `index` into `layout`.
  struct Transition {
    int index;
    VkImageLayout layout;
  };
  void barrier(VkCommandBuffer commands, std::span<const Transition> transitions);

 private:
  void upload_buffer(VkCommandBuffer commands, std::size_t index);
  void upload_texture(VkCommandBuffer commands, std::size_t index);
  void clear_texture(VkCommandBuffer commands, std::size_t index);
  void download_texture(VkCommandBuffer commands, const ReadBack& read_back);
  VkBufferImageCopy copy_of(const Texture& texture, int level, std::size_t offset) const;

  const Device& device_;
  const Job& job_;
  std::vector<DeviceBuffer> buffers_;
  std::vector<DeviceImage> images_;
  std::vector<DeviceBuffer> uploads_;
  std::vector<DeviceBuffer> downloads_;  ///< one a read-back; empty where the host sees the buffer itself
};

}  // namespace relievo::vulkan
