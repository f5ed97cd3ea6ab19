#include "resources.hpp"

#include <algorithm>
#include <cstring>

namespace {

VkSamplerAddressMode address_mode(relievo::TexelAddress address) {
  if (address == relievo::TexelAddress::repeat) return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  return address == relievo::TexelAddress::mirror ? VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT
                                                  : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
}

VkImageAspectFlags aspect(const relievo::Texture& texture) {
  return texture.format == relievo::Format::d32_float ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

std::uint32_t layers(const relievo::Texture& texture) {
  return texture.is_array ? static_cast<std::uint32_t>(texture.depth) : 1;
}

VkImage make_image(Vulkan& vulkan, const relievo::Texture& texture, VkImageType type, VkImageUsageFlags usage) {
  const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                  .imageType = type,
                                  .format = to_vulkan(texture.format),
                                  .extent = extent(texture, 0),
                                  .mipLevels = static_cast<std::uint32_t>(texture.levels),
                                  .arrayLayers = layers(texture),
                                  .samples = VK_SAMPLE_COUNT_1_BIT,
                                  .usage = usage};
  const VkImage image = vulkan.make(vkCreateImage, vkDestroyImage, info);
  VkMemoryRequirements needs = {};
  vkGetImageMemoryRequirements(vulkan.device, image, &needs);
  check(vkBindImageMemory(vulkan.device, image, vulkan.allocate(needs, 0), 0), "binding an image's memory");
  return image;
}

VkSampler make_sampler(Vulkan& vulkan, const relievo::SamplerState& state) {
  const bool linear = state.min_mag == relievo::TexelFilter::linear,
             linear_mip = state.mip == relievo::TexelFilter::linear;
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
  return vulkan.make(vkCreateSampler, vkDestroySampler, info);
}

/// A texture with contents is sampled; one without is a target of the Draw.
Image make_texture(Vulkan& vulkan, const relievo::Texture& texture) {
  const bool is_3d = !texture.is_array && (texture.is_3d || texture.depth > 1);
  const VkImageUsageFlags target = aspect(texture) == VK_IMAGE_ASPECT_DEPTH_BIT
                                       ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                       : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  const VkImageUsageFlags source = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  Image made;
  made.image =
      make_image(vulkan, texture, is_3d ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D, texture.data.empty() ? target : source);
  const VkImageViewCreateInfo view = {
      .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
      .image = made.image,
      .viewType = is_3d              ? VK_IMAGE_VIEW_TYPE_3D
                  : texture.is_array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                     : VK_IMAGE_VIEW_TYPE_2D,
      .format = to_vulkan(texture.format),
      .subresourceRange = {aspect(texture), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}};
  made.view = vulkan.make(vkCreateImageView, vkDestroyImageView, view);
  made.sampler = make_sampler(vulkan, texture.sampler);
  return made;
}

VkImageMemoryBarrier2 to_general(const relievo::Texture& texture, VkImage image) {
  return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
          .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
          .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
          .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
          .newLayout = VK_IMAGE_LAYOUT_GENERAL,
          .image = image,
          .subresourceRange = {aspect(texture), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}};
}

}  // namespace

VkFormat to_vulkan(relievo::Format format) {
  using relievo::Format;
  constexpr std::pair<Format, VkFormat> formats[] = {{Format::r8_unorm, VK_FORMAT_R8_UNORM},
                                                     {Format::rg8_unorm, VK_FORMAT_R8G8_UNORM},
                                                     {Format::rgba8_unorm, VK_FORMAT_R8G8B8A8_UNORM},
                                                     {Format::r16_unorm, VK_FORMAT_R16_UNORM},
                                                     {Format::rg16_unorm, VK_FORMAT_R16G16_UNORM},
                                                     {Format::rgba16_unorm, VK_FORMAT_R16G16B16A16_UNORM},
                                                     {Format::r32_float, VK_FORMAT_R32_SFLOAT},
                                                     {Format::rg32_float, VK_FORMAT_R32G32_SFLOAT},
                                                     {Format::rgb32_float, VK_FORMAT_R32G32B32_SFLOAT},
                                                     {Format::rgba32_float, VK_FORMAT_R32G32B32A32_SFLOAT},
                                                     {Format::r32_uint, VK_FORMAT_R32_UINT},
                                                     {Format::rgba16_uint, VK_FORMAT_R16G16B16A16_UINT},
                                                     {Format::d32_float, VK_FORMAT_D32_SFLOAT}};
  for (const auto& [ours, theirs] : formats) {
    if (ours == format) return theirs;
  }
  refuse("it has the format " + std::string(to_string(format)));
}

VkExtent3D extent(const relievo::Texture& texture, int level) {
  const auto size = [level](int full) { return static_cast<std::uint32_t>(std::max(1, full >> level)); };
  return {size(texture.width), size(texture.height), texture.is_array ? 1 : size(texture.depth)};
}

VkBufferImageCopy copy_of(const relievo::Texture& texture, int level) {
  return {.imageSubresource = {aspect(texture), static_cast<std::uint32_t>(level), 0, layers(texture)},
          .imageExtent = extent(texture, level)};
}

HostBuffer make_buffer(Vulkan& vulkan, std::size_t size, const std::vector<std::byte>& contents) {
  const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                   .size = size,
                                   .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                            VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                                            VK_BUFFER_USAGE_VERTEX_BUFFER_BIT};
  HostBuffer made = {vulkan.make(vkCreateBuffer, vkDestroyBuffer, info), nullptr};
  VkMemoryRequirements needs = {};
  vkGetBufferMemoryRequirements(vulkan.device, made.buffer, &needs);
  const VkDeviceMemory memory =
      vulkan.allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  check(vkBindBufferMemory(vulkan.device, made.buffer, memory, 0), "binding a buffer's memory");
  void* bytes = nullptr;
  check(vkMapMemory(vulkan.device, memory, 0, VK_WHOLE_SIZE, 0, &bytes), "mapping a buffer");
  made.bytes = static_cast<std::byte*>(bytes);
  std::memset(made.bytes, 0, size);  // what a Job does not say is zero
  std::copy(contents.begin(), contents.end(), made.bytes);
  return made;
}

void barrier(Vulkan& vulkan, const std::vector<VkImageMemoryBarrier2>& images) {
  const VkMemoryBarrier2 all = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
  const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                 .memoryBarrierCount = 1,
                                 .pMemoryBarriers = &all,
                                 .imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size()),
                                 .pImageMemoryBarriers = images.data()};
  vkCmdPipelineBarrier2(vulkan.commands, &info);
}

Resources upload(Vulkan& vulkan, const relievo::Job& job) {
  Resources made;
  for (const relievo::Buffer& buffer : job.buffers)
    made.buffers.push_back(make_buffer(vulkan, buffer.size, buffer.data));
  std::vector<VkImageMemoryBarrier2> transitions;
  for (const relievo::Texture& texture : job.textures) {
    made.images.push_back(make_texture(vulkan, texture));
    transitions.push_back(to_general(texture, made.images.back().image));
  }
  barrier(vulkan, transitions);
  for (std::size_t i = 0; i < job.textures.size(); ++i) {
    for (std::size_t level = 0; level < job.textures[i].data.size(); ++level) {
      const std::vector<std::byte>& texels = job.textures[i].data[level];
      const VkBufferImageCopy copy = copy_of(job.textures[i], static_cast<int>(level));
      vkCmdCopyBufferToImage(vulkan.commands, make_buffer(vulkan, texels.size(), texels).buffer, made.images[i].image,
                             VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    }
  }
  barrier(vulkan);
  return made;
}
