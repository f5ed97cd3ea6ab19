/// What any Vulkan application has: an instance, a device, a queue, memory and a command buffer.
#pragma once

#include <vulkan/vulkan.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

/// Throws a sentence unless all is well.
inline void check(VkResult result, const char* what) {
  if (result != VK_SUCCESS)
    throw std::runtime_error(std::string(what) + " fails with VkResult " + std::to_string(result));
}

/// What is made is destroyed in the opposite order.
class Vulkan {
 public:
  Vulkan();
  ~Vulkan() {
    for (auto destroy = cleanup_.rbegin(); destroy != cleanup_.rend(); ++destroy) (*destroy)();
  }
  Vulkan(const Vulkan&) = delete;
  Vulkan& operator=(const Vulkan&) = delete;

  /// `make(vkCreateSampler, vkDestroySampler, info)`.
  template <class Handle, class Info>
  Handle make(VkResult (*create)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
              void (*destroy)(VkDevice, Handle, const VkAllocationCallbacks*), const Info& info) {
    Handle handle = VK_NULL_HANDLE;
    check(create(device, &info, nullptr, &handle), "making a Vulkan object");
    cleanup_.push_back([=, this] { destroy(device, handle, nullptr); });
    return handle;
  }
  VkPipeline make_pipeline(const VkGraphicsPipelineCreateInfo& info);
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted);
  void submit_and_wait();

  VkDevice device = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;

 private:
  void open_device();

  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice gpu_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::vector<std::function<void()>> cleanup_;
};
