/// The Vulkan loader, an instance, and the choice of a device.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "api.hpp"
#include "relievo/backend.hpp"

namespace relievo::vulkan {

/// What the validation layer says; drivers may call from their own threads.
class Messages {
 public:
  void add(std::string message);
  std::vector<std::string> take();

 private:
  std::mutex mutex_;
  std::vector<std::string> messages_;
};

class Instance {
 public:
  /// With `messages`, the validation layer is on and reports there. Throws "backend.unavailable" without a loader or
  /// driver, and "backend.validation-missing".
  explicit Instance(Messages* messages);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return instance_; }

 private:
  Instance() = default;

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// What is known of a device before it is opened.
struct DeviceTraits {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties = {};
  VkPhysicalDeviceFeatures features = {};
  VkPhysicalDeviceMemoryProperties memory = {};
  std::string driver;
  bool has_vulkan_13 = false;        ///< the version, dynamic rendering and synchronization2
  int queue_family = -1;             ///< graphics and compute; −1 = none
  std::uint32_t timestamp_bits = 0;  ///< of that queue family
  bool filters_float32 = false;
};

/// The first suitable device whose name contains `filter`: discrete GPUs before integrated and virtual ones before
/// CPUs. Throws "backend.unavailable", or "backend.device" when only the filter rules devices out.
DeviceTraits choose_device(const Instance& instance, const std::string& filter);

bool has_validation_layer();

/// Held while volk's process-wide function pointers are loaded or called.
std::unique_lock<std::mutex> lock_loader();

}  // namespace relievo::vulkan
