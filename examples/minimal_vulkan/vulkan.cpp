#include "vulkan.hpp"

Vulkan::Vulkan() {
  const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                         .pApplicationName = "minimal_vulkan",
                                         .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
  check(vkCreateInstance(&info, nullptr, &instance_), "creating the instance");
  cleanup_.push_back([this] { vkDestroyInstance(instance_, nullptr); });
  open_device();
}

/// The first device and its first queue family, which draws on every driver there is.
void Vulkan::open_device() {
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(instance_, &count, &gpu_) < 0 || count == 0)
    throw std::runtime_error("no Vulkan device is found");
  const float priority = 1;
  const VkDeviceQueueCreateInfo queue = {
      .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
  const VkPhysicalDeviceVulkan13Features features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                     .synchronization2 = VK_TRUE,
                                                     .dynamicRendering = VK_TRUE};
  const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                   .pNext = &features,
                                   .queueCreateInfoCount = 1,
                                   .pQueueCreateInfos = &queue};
  check(vkCreateDevice(gpu_, &info, nullptr, &device), "creating the device");
  cleanup_.push_back([this] { vkDestroyDevice(device, nullptr); });
  vkGetDeviceQueue(device, 0, 0, &queue_);

  const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  const VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = make(vkCreateCommandPool, vkDestroyCommandPool, pool),
                                              .commandBufferCount = 1};
  check(vkAllocateCommandBuffers(device, &buffer, &commands), "allocating the command buffer");
  const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  check(vkBeginCommandBuffer(commands, &begin), "beginning the commands");
}

VkPipeline Vulkan::make_pipeline(const VkGraphicsPipelineCreateInfo& info) {
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "compiling the program");
  cleanup_.push_back([=, this] { vkDestroyPipeline(device, pipeline, nullptr); });
  return pipeline;
}

VkDeviceMemory Vulkan::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties memory = {};
  vkGetPhysicalDeviceMemoryProperties(gpu_, &memory);
  for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
    const bool fits = needs.memoryTypeBits >> type & 1u;
    if (!fits || (memory.memoryTypes[type].propertyFlags & wanted) != wanted) continue;
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = type};
    return make(vkAllocateMemory, vkFreeMemory, info);
  }
  throw std::runtime_error("no memory type fits");
}

void Vulkan::submit_and_wait() {
  check(vkEndCommandBuffer(commands), "ending the commands");
  const VkSubmitInfo submit = {
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
  check(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "submitting");
  check(vkQueueWaitIdle(queue_), "drawing");
}
