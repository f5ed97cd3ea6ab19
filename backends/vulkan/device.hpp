/// An opened device: its functions, queue, memory and messages.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "api.hpp"
#include "instance.hpp"
#include "relievo/backend.hpp"

namespace relievo::vulkan {

constexpr VkMemoryPropertyFlags seen_by_host =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
/// Memory that the host reads as fast as its own; not what it sees of a graphics card's through a bus.
constexpr VkMemoryPropertyFlags shared_with_host =
    seen_by_host | VK_MEMORY_PROPERTY_HOST_CACHED_BIT | VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;

constexpr bool has_all(VkMemoryPropertyFlags flags, VkMemoryPropertyFlags wanted) {
  return (flags & wanted) == wanted;
}

class Device {
 public:
  explicit Device(const BackendOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// The device's own functions: calls through them need no lock.
  VolkDeviceTable vk = {};

  VkDevice handle() const { return device_; }
  const DeviceTraits& traits() const { return traits_; }
  /// What memory must be for the host to see buffers in it; more than any memory is, where all are to be copied.
  VkMemoryPropertyFlags shared_memory() const { return shared_memory_; }
  const VkPhysicalDeviceLimits& limits() const { return traits_.properties.limits; }
  Messages& messages() { return messages_; }

  /// `create(vk.vkCreateSampler, vk.vkDestroySampler, info, "creating …")`: every device object comes from here.
  template <class Handle, class Info>
  Unique<Handle> create(VkResult(VKAPI_PTR* make)(VkDevice, const Info*, const VkAllocationCallbacks*, Handle*),
                        void(VKAPI_PTR* destroy)(VkDevice, Handle, const VkAllocationCallbacks*),
                        const std::type_identity_t<Info>& info, std::string_view what) const {
    Handle made = VK_NULL_HANDLE;
    check(make(device_, &info, nullptr, &made), what);
    return own(made, destroy);
  }

  template <class Handle>
  Unique<Handle> own(Handle handle, void(VKAPI_PTR* destroy)(VkDevice, Handle, const VkAllocationCallbacks*)) const {
    return Unique<Handle>(handle, Destroy<Handle>{device_, destroy});
  }

  /// The first type of memory that has all flags of the first wish that can be granted.
  std::uint32_t memory_type(const VkMemoryRequirements& requirements, std::span<const VkMemoryPropertyFlags> wishes,
                            std::string_view what) const;
  Unique<VkDeviceMemory> allocate(const VkMemoryRequirements& requirements, std::uint32_t type,
                                  std::string_view what) const;

  VkFormatFeatureFlags format_features(VkFormat format) const;
  /// Throws "backend.format" when the device cannot make such an image.
  void check_image(const VkImageCreateInfo& info, std::string_view texture) const;

  /// Records commands, runs them and waits for their end.
  void run(const std::function<void(VkCommandBuffer)>& record);

 private:
  Messages messages_;
  Instance instance_;
  DeviceTraits traits_;
  VkMemoryPropertyFlags shared_memory_;
  PFN_vkGetPhysicalDeviceFormatProperties get_format_properties_ = nullptr;
  PFN_vkGetPhysicalDeviceImageFormatProperties get_image_format_properties_ = nullptr;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
};

}  // namespace relievo::vulkan
