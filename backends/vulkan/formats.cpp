#include "formats.hpp"

#include <cstring>

namespace relievo::vulkan {

namespace {

/// One in the fourth channel of the format.
std::vector<std::byte> opaque(Format format) {
  const float one = 1;
  std::vector<std::byte> alpha(image_texel_size(format) / 4, std::byte{0xff});
  if (format == Format::rgb32_float) std::memcpy(alpha.data(), &one, sizeof one);
  return alpha;
}

}  // namespace

VkFormat image_format(Format format) {
  switch (format) {
    case Format::r8_unorm:
      return VK_FORMAT_R8_UNORM;
    case Format::rg8_unorm:
      return VK_FORMAT_R8G8_UNORM;
    case Format::rgb8_unorm:
    case Format::rgba8_unorm:
      return VK_FORMAT_R8G8B8A8_UNORM;
    case Format::r16_unorm:
      return VK_FORMAT_R16_UNORM;
    case Format::rg16_unorm:
      return VK_FORMAT_R16G16_UNORM;
    case Format::rgb16_unorm:
    case Format::rgba16_unorm:
      return VK_FORMAT_R16G16B16A16_UNORM;
    case Format::r32_float:
      return VK_FORMAT_R32_SFLOAT;
    case Format::rg32_float:
      return VK_FORMAT_R32G32_SFLOAT;
    case Format::rgb32_float:
    case Format::rgba32_float:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
    case Format::r32_uint:
      return VK_FORMAT_R32_UINT;
    case Format::d32_float:
      return VK_FORMAT_D32_SFLOAT;
    case Format::rgba16_uint:
      return VK_FORMAT_R16G16B16A16_UINT;
  }
  return VK_FORMAT_UNDEFINED;
}

VkFormat vertex_format(Format format) {
  return format == Format::rgb32_float ? VK_FORMAT_R32G32B32_SFLOAT : image_format(format);
}

VkImageAspectFlags aspect(Format format) {
  return format == Format::d32_float ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

std::size_t image_texel_size(Format format) {
  const auto size = static_cast<std::size_t>(bytes_per_texel(format));
  return channel_count(format) == 3 ? size / 3 * 4 : size;
}

void pack_texels(Format format, const std::vector<std::byte>& texels, std::byte* image) {
  const auto size = static_cast<std::size_t>(bytes_per_texel(format));
  if (channel_count(format) != 3) {
    std::memcpy(image, texels.data(), texels.size());
    return;
  }
  const std::vector<std::byte> alpha = opaque(format);
  for (std::size_t i = 0; i < texels.size(); i += size, image += size + alpha.size()) {
    std::memcpy(image, texels.data() + i, size);
    std::memcpy(image + size, alpha.data(), alpha.size());
  }
}

void unpack_texels(Format format, const std::byte* image, std::vector<std::byte>& texels) {
  const auto size = static_cast<std::size_t>(bytes_per_texel(format));
  if (channel_count(format) != 3) {
    std::memcpy(texels.data(), image, texels.size());
    return;
  }
  for (std::size_t i = 0; i < texels.size(); i += size, image += image_texel_size(format)) {
    std::memcpy(texels.data() + i, image, size);
  }
}

}  // namespace relievo::vulkan
