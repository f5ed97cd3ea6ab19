#include "resources.hpp"

#include <cstring>
#include <utility>

#include "creation.hpp"
#include "formats.hpp"

namespace relievo::vulkan {

namespace {

std::size_t image_level_size(const Texture& texture, int level) {
  return level_size(texture, level) / static_cast<std::size_t>(bytes_per_texel(texture.format)) *
         image_texel_size(texture.format);
}

// Copies start at multiples of the texel size and of four bytes.
std::size_t align(std::size_t offset) {
  return (offset + 15) / 16 * 16;
}

/// Where each level starts in a buffer that holds all of them, and the end.
std::vector<std::size_t> level_offsets(const Texture& texture) {
  std::vector<std::size_t> offsets = {0};
  for (int level = 0; level < texture.levels; ++level) {
    offsets.push_back(align(offsets.back() + image_level_size(texture, level)));
  }
  return offsets;
}

void memory_barrier(const Device& device, VkCommandBuffer commands, std::span<const VkImageMemoryBarrier2> images,
                    VkPipelineStageFlags2 until, VkAccessFlags2 access) {
  const VkMemoryBarrier2 memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                   .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                   .dstStageMask = until,
                                   .dstAccessMask = access};
  const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                 .memoryBarrierCount = 1,
                                 .pMemoryBarriers = &memory,
                                 .imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size()),
                                 .pImageMemoryBarriers = images.data()};
  device.vk.vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

Resources::Resources(const Device& device, const Job& job) : device_(device), job_(job) {
  for (const Buffer& buffer : job.buffers) buffers_.push_back(create_buffer(device, buffer));
  const std::vector<VkImageUsageFlags> usages = texture_usages(job);
  for (std::size_t i = 0; i < job.textures.size(); ++i) {
    images_.push_back(create_image(device, job.textures[i], usages[i]));
  }
}

void Resources::upload(VkCommandBuffer commands) {
  std::vector<Transition> transitions;
  for (std::size_t i = 0; i < images_.size(); ++i) {
    transitions.push_back({static_cast<int>(i), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL});
  }
  barrier(commands, transitions);
  for (std::size_t i = 0; i < buffers_.size(); ++i) upload_buffer(commands, i);
  for (std::size_t i = 0; i < images_.size(); ++i) {
    job_.textures[i].data.empty() ? clear_texture(commands, i) : upload_texture(commands, i);
  }
}

void Resources::upload_buffer(VkCommandBuffer commands, std::size_t index) {
  const Buffer& source = job_.buffers[index];
  const VkBuffer target = buffers_[index].buffer.get();
  if (std::byte* bytes = buffers_[index].bytes) {
    source.data.empty() ? std::memset(bytes, 0, source.size) : std::memcpy(bytes, source.data.data(), source.size);
    return;
  }
  if (source.data.empty()) {
    device_.vk.vkCmdFillBuffer(commands, target, 0, VK_WHOLE_SIZE, 0);
    return;
  }
  uploads_.push_back(create_host_buffer(device_, source.size, 0));
  std::memcpy(uploads_.back().bytes, source.data.data(), source.size);
  const VkBufferCopy copy = {.size = source.size};
  device_.vk.vkCmdCopyBuffer(commands, uploads_.back().buffer.get(), target, 1, &copy);
}

void Resources::upload_texture(VkCommandBuffer commands, std::size_t index) {
  const Texture& texture = job_.textures[index];
  const std::vector<std::size_t> offsets = level_offsets(texture);
  uploads_.push_back(create_host_buffer(device_, offsets.back(), 0));
  std::vector<VkBufferImageCopy> copies;
  for (int level = 0; level < texture.levels; ++level) {
    const auto i = static_cast<std::size_t>(level);
    pack_texels(texture.format, texture.data[i], uploads_.back().bytes + offsets[i]);
    copies.push_back(copy_of(texture, level, offsets[i]));
  }
  device_.vk.vkCmdCopyBufferToImage(commands, uploads_.back().buffer.get(), images_[index].image.get(),
                                    images_[index].layout, static_cast<std::uint32_t>(copies.size()), copies.data());
}

void Resources::clear_texture(VkCommandBuffer commands, std::size_t index) {
  const Texture& texture = job_.textures[index];
  const DeviceImage& image = images_[index];
  const VkImageSubresourceRange range = {.aspectMask = aspect(texture.format),
                                         .levelCount = static_cast<std::uint32_t>(texture.levels),
                                         .layerCount = layer_count(texture)};
  const VkClearColorValue black = {};
  const VkClearDepthStencilValue near = {};
  if (texture.format == Format::d32_float) {
    device_.vk.vkCmdClearDepthStencilImage(commands, image.image.get(), image.layout, &near, 1, &range);
  } else {
    device_.vk.vkCmdClearColorImage(commands, image.image.get(), image.layout, &black, 1, &range);
  }
}

void Resources::download(VkCommandBuffer commands) {
  std::vector<Transition> transitions;
  for (const ReadBack& read_back : job_.read_backs) {
    if (read_back.source == ReadBack::Source::texture) {
      transitions.push_back({read_back.index, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL});
    }
  }
  barrier(commands, transitions);
  for (const ReadBack& read_back : job_.read_backs) {
    if (read_back.source == ReadBack::Source::texture) {
      download_texture(commands, read_back);
      continue;
    }
    const auto index = static_cast<std::size_t>(read_back.index);
    if (buffers_[index].bytes != nullptr) {
      downloads_.emplace_back();
      continue;
    }
    const VkBufferCopy copy = {.size = job_.buffers[index].size};
    downloads_.push_back(create_host_buffer(device_, copy.size, VK_MEMORY_PROPERTY_HOST_CACHED_BIT));
    device_.vk.vkCmdCopyBuffer(commands, buffer(read_back.index), downloads_.back().buffer.get(), 1, &copy);
  }
  memory_barrier(device_, commands, {}, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

void Resources::download_texture(VkCommandBuffer commands, const ReadBack& read_back) {
  const Texture& texture = job_.textures[static_cast<std::size_t>(read_back.index)];
  const DeviceImage& source = image(read_back.index);
  downloads_.push_back(
      create_host_buffer(device_, image_level_size(texture, read_back.level), VK_MEMORY_PROPERTY_HOST_CACHED_BIT));
  const VkBufferImageCopy copy = copy_of(texture, read_back.level, 0);
  device_.vk.vkCmdCopyImageToBuffer(commands, source.image.get(), source.layout, downloads_.back().buffer.get(), 1,
                                    &copy);
}

void Resources::read_back(const TakeReadBack& take) {
  images_.clear();
  for (std::size_t i = 0; i < job_.read_backs.size(); ++i) {
    const ReadBack& read_back = job_.read_backs[i];
    const auto index = static_cast<std::size_t>(read_back.index);
    const DeviceBuffer download = std::exchange(downloads_[i], {});
    if (read_back.source == ReadBack::Source::buffer) {
      const std::byte* bytes = download.bytes != nullptr ? download.bytes : buffers_[index].bytes;
      take(i, {bytes, job_.buffers[index].size});
      continue;
    }
    const Texture& texture = job_.textures[index];
    std::vector<std::byte> texels(level_size(texture, read_back.level));
    unpack_texels(texture.format, download.bytes, texels);
    take(i, texels);
  }
}

void Resources::barrier(VkCommandBuffer commands, std::span<const Transition> transitions) {
  std::vector<VkImageMemoryBarrier2> barriers;
  for (const auto& [index, layout] : transitions) {
    DeviceImage& changed = image(index);
    const VkImageLayout old = std::exchange(changed.layout, layout);
    if (old == layout) continue;
    barriers.push_back(
        {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
         .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
         .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
         .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
         .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
         .oldLayout = old,
         .newLayout = layout,
         .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
         .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
         .image = changed.image.get(),
         .subresourceRange = {.aspectMask = aspect(job_.textures[static_cast<std::size_t>(index)].format),
                              .levelCount = VK_REMAINING_MIP_LEVELS,
                              .layerCount = VK_REMAINING_ARRAY_LAYERS}});
  }
  memory_barrier(device_, commands, barriers, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                 VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

VkBufferImageCopy Resources::copy_of(const Texture& texture, int level, std::size_t offset) const {
  return {.bufferOffset = offset,
          .imageSubresource = {.aspectMask = aspect(texture.format),
                               .mipLevel = static_cast<std::uint32_t>(level),
                               .layerCount = layer_count(texture)},
          .imageExtent = level_extent(texture, level)};
}

}  // namespace relievo::vulkan
