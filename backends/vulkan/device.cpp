#include "device.hpp"

namespace relievo::vulkan {

namespace {

/// The features that shaders of the SDK may use, where the device has them. Robust access keeps a wrong index in a
/// job's buffer from reading other memory.
VkPhysicalDeviceFeatures wanted_features(const VkPhysicalDeviceFeatures& offered) {
  VkPhysicalDeviceFeatures wanted = {};
  wanted.robustBufferAccess = offered.robustBufferAccess;
  wanted.fullDrawIndexUint32 = offered.fullDrawIndexUint32;
  wanted.independentBlend = offered.independentBlend;
  wanted.geometryShader = offered.geometryShader;
  wanted.tessellationShader = offered.tessellationShader;
  wanted.vertexPipelineStoresAndAtomics = offered.vertexPipelineStoresAndAtomics;
  wanted.fragmentStoresAndAtomics = offered.fragmentStoresAndAtomics;
  wanted.shaderFloat64 = offered.shaderFloat64;
  wanted.shaderImageGatherExtended = offered.shaderImageGatherExtended;
  wanted.shaderStorageImageExtendedFormats = offered.shaderStorageImageExtendedFormats;
  return wanted;
}

VkDevice create_device(const DeviceTraits& traits) {
  const float priority = 1;
  const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                         .queueFamilyIndex = static_cast<std::uint32_t>(traits.queue_family),
                                         .queueCount = 1,
                                         .pQueuePriorities = &priority};
  VkPhysicalDeviceVulkan13Features features_13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                  .synchronization2 = VK_TRUE,
                                                  .dynamicRendering = VK_TRUE};
  const VkPhysicalDeviceFeatures features = wanted_features(traits.features);
  const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                   .pNext = &features_13,
                                   .queueCreateInfoCount = 1,
                                   .pQueueCreateInfos = &queue,
                                   .pEnabledFeatures = &features};
  VkDevice device = VK_NULL_HANDLE;
  check(vkCreateDevice(traits.handle, &info, nullptr, &device), "opening the Vulkan device");
  return device;
}

}  // namespace

Device::Device(const BackendOptions& options)
    : instance_(options.validation ? &messages_ : nullptr),
      traits_(choose_device(instance_, options.device)),
      shared_memory_(options.copies_always ? ~VkMemoryPropertyFlags{0} : shared_with_host) {
  const auto lock = lock_loader();
  get_format_properties_ = vkGetPhysicalDeviceFormatProperties;
  get_image_format_properties_ = vkGetPhysicalDeviceImageFormatProperties;
  device_ = create_device(traits_);
  volkLoadDeviceTable(&vk, device_);
  vk.vkGetDeviceQueue(device_, static_cast<std::uint32_t>(traits_.queue_family), 0, &queue_);
}

Device::~Device() {
  vk.vkDestroyDevice(device_, nullptr);
}

Unique<VkDeviceMemory> Device::allocate(const VkMemoryRequirements& requirements, std::uint32_t type,
                                        std::string_view what) const {
  const VkMemoryAllocateInfo info = {
      .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = requirements.size, .memoryTypeIndex = type};
  return create(vk.vkAllocateMemory, vk.vkFreeMemory, info, what);
}

std::uint32_t Device::memory_type(const VkMemoryRequirements& requirements,
                                  std::span<const VkMemoryPropertyFlags> wishes, std::string_view what) const {
  for (const VkMemoryPropertyFlags flags : wishes) {
    for (std::uint32_t type = 0; type < traits_.memory.memoryTypeCount; ++type) {
      const bool allowed = (requirements.memoryTypeBits >> type & 1u) != 0;
      if (allowed && has_all(traits_.memory.memoryTypes[type].propertyFlags, flags)) return type;
    }
  }
  refuse(ErrorCode::unsupported, "backend.memory", "{} fails: the device has no memory of a suitable type", what);
}

VkFormatFeatureFlags Device::format_features(VkFormat format) const {
  VkFormatProperties properties = {};
  get_format_properties_(traits_.handle, format, &properties);
  return properties.optimalTilingFeatures;
}

void Device::check_image(const VkImageCreateInfo& info, std::string_view texture) const {
  VkImageFormatProperties most = {};
  const VkResult result = get_image_format_properties_(traits_.handle, info.format, info.imageType, info.tiling,
                                                       info.usage, info.flags, &most);
  if (result == VK_ERROR_FORMAT_NOT_SUPPORTED) {
    refuse(ErrorCode::unsupported, "backend.format",
           "The device cannot use texture \"{}\" of VkFormat {} as the job does", texture,
           static_cast<int>(info.format));
  }
  check(result, fmt::format("asking for the limits of texture \"{}\"", texture));
  const VkExtent3D& limit = most.maxExtent;
  if (info.extent.width > limit.width || info.extent.height > limit.height || info.extent.depth > limit.depth) {
    refuse(ErrorCode::unsupported, "backend.limit",
           "Texture \"{}\" is {}x{}x{} texels, the device takes up to {}x{}x{}", texture, info.extent.width,
           info.extent.height, info.extent.depth, limit.width, limit.height, limit.depth);
  }
  if (info.arrayLayers > most.maxArrayLayers) {
    refuse(ErrorCode::unsupported, "backend.limit", "Texture \"{}\" has {} layers, the device takes up to {}", texture,
           info.arrayLayers, most.maxArrayLayers);
  }
}

void Device::run(const std::function<void(VkCommandBuffer)>& record) {
  const VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                             .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                             .queueFamilyIndex = static_cast<std::uint32_t>(traits_.queue_family)};
  const auto pool = create(vk.vkCreateCommandPool, vk.vkDestroyCommandPool, pool_info, "creating a command pool");
  const VkCommandBufferAllocateInfo allocate_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                     .commandPool = pool.get(),
                                                     .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                     .commandBufferCount = 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vk.vkAllocateCommandBuffers(device_, &allocate_info, &commands), "allocating a command buffer");

  const VkCommandBufferBeginInfo begin_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                               .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vk.vkBeginCommandBuffer(commands, &begin_info), "beginning to record");
  record(commands);
  check(vk.vkEndCommandBuffer(commands), "recording the commands");

  const VkCommandBufferSubmitInfo command_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                                  .commandBuffer = commands};
  const VkSubmitInfo2 submit_info = {
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &command_info};
  check(vk.vkQueueSubmit2(queue_, 1, &submit_info, VK_NULL_HANDLE), "submitting the commands");
  check(vk.vkQueueWaitIdle(queue_), "waiting for the commands");
}

}  // namespace relievo::vulkan
