/// Job formats as Vulkan's. Three-channel textures live as four channels, since few devices sample three.
#pragma once

#include <cstddef>
#include <vector>

#include "api.hpp"
#include "relievo/job.hpp"

namespace relievo::vulkan {

VkFormat image_format(Format format);
VkFormat vertex_format(Format format);

VkImageAspectFlags aspect(Format format);

/// Bytes of a texel in the image, which differ from bytes_per_texel() for three channels.
std::size_t image_texel_size(Format format);

/// Copies tightly packed texels of the job into those of the image; a fourth channel that the job lacks is one.
void pack_texels(Format format, const std::vector<std::byte>& texels, std::byte* image);
/// The reverse, for as many texels as `texels` holds.
void unpack_texels(Format format, const std::byte* image, std::vector<std::byte>& texels);

}  // namespace relievo::vulkan
