#include "instance.hpp"

#include <algorithm>
#include <cstring>

namespace relievo::vulkan {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

void open_loader() {
  if (volkGetInstanceVersion() != 0) return;
  if (volkInitialize() != VK_SUCCESS) {
    refuse(ErrorCode::unsupported, "backend.unavailable", "The Vulkan loader (libvulkan.so.1) cannot be opened");
  }
}

bool layer_is_installed() {
  std::uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
    return std::strcmp(layer.layerName, validation_layer) == 0;
  });
}

VkInstance create_instance(bool validation) {
  const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                         .pApplicationName = "relievo",
                                         .pEngineName = "relievo",
                                         .apiVersion = VK_API_VERSION_1_3};
  const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                     .pApplicationInfo = &application,
                                     .enabledLayerCount = validation ? 1u : 0u,
                                     .ppEnabledLayerNames = &validation_layer,
                                     .enabledExtensionCount = validation ? 1u : 0u,
                                     .ppEnabledExtensionNames = &extension};
  VkInstance instance = VK_NULL_HANDLE;
  const VkResult result = vkCreateInstance(&info, nullptr, &instance);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
    refuse(ErrorCode::unsupported, "backend.unavailable", "The Vulkan loader finds no driver");
  }
  check(result, "creating the Vulkan instance");
  return instance;
}

VKAPI_ATTR VkBool32 VKAPI_CALL report(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                      const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages) {
  static_cast<Messages*>(messages)->add(data->pMessage);
  return VK_FALSE;
}

VkDebugUtilsMessengerEXT create_messenger(VkInstance instance, Messages* messages) {
  // Not the general type: loaders and drivers use it to talk about themselves.
  const VkDebugUtilsMessengerCreateInfoEXT info = {
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity =
          VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
      .pfnUserCallback = report,
      .pUserData = messages};
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  check(vkCreateDebugUtilsMessengerEXT(instance, &info, nullptr, &messenger), "creating the debug messenger");
  return messenger;
}

void find_queue(DeviceTraits& device) {
  constexpr VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device.handle, &count, families.data());
  const auto found = std::find_if(families.begin(), families.end(), [](const VkQueueFamilyProperties& family) {
    return (family.queueFlags & needed) == needed;
  });
  if (found == families.end()) return;
  device.queue_family = static_cast<int>(found - families.begin());
  device.timestamp_bits = found->timestampValidBits;
}

bool filters_linearly(VkPhysicalDevice device, VkFormat format) {
  VkFormatProperties properties = {};
  vkGetPhysicalDeviceFormatProperties(device, format, &properties);
  return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
}

/// Structures of Vulkan 1.3 may be asked for only where the device has that version.
void query_vulkan_13(DeviceTraits& device) {
  VkPhysicalDeviceVulkan13Features features_13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features_13};
  vkGetPhysicalDeviceFeatures2(device.handle, &features);
  device.has_vulkan_13 = features_13.dynamicRendering && features_13.synchronization2;

  VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
  vkGetPhysicalDeviceProperties2(device.handle, &properties);
  device.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
}

DeviceTraits query(VkPhysicalDevice handle) {
  DeviceTraits device;
  device.handle = handle;
  vkGetPhysicalDeviceProperties(handle, &device.properties);
  vkGetPhysicalDeviceFeatures(handle, &device.features);
  vkGetPhysicalDeviceMemoryProperties(handle, &device.memory);
  if (device.properties.apiVersion >= VK_API_VERSION_1_3) query_vulkan_13(device);
  find_queue(device);
  device.filters_float32 =
      filters_linearly(handle, VK_FORMAT_R32_SFLOAT) && filters_linearly(handle, VK_FORMAT_R32G32B32A32_SFLOAT);
  return device;
}

int rank(const DeviceTraits& device) {
  switch (device.properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 2;
    default:
      return 3;
  }
}

std::vector<DeviceTraits> query_devices(VkInstance instance) {
  std::uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "listing the Vulkan devices");
  std::vector<VkPhysicalDevice> handles(count);
  check(vkEnumeratePhysicalDevices(instance, &count, handles.data()), "listing the Vulkan devices");
  std::vector<DeviceTraits> devices;
  for (VkPhysicalDevice handle : handles) devices.push_back(query(handle));
  std::stable_sort(devices.begin(), devices.end(), [](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return devices;
}

std::string names(const std::vector<DeviceTraits>& devices) {
  std::string list;
  for (const DeviceTraits& device : devices) {
    const std::uint32_t version = device.properties.apiVersion;
    list += fmt::format("{}\"{}\" (Vulkan {}.{})", list.empty() ? "" : ", ", device.properties.deviceName,
                        VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
  }
  return list;
}

}  // namespace

void Messages::add(std::string message) {
  const std::lock_guard lock(mutex_);
  messages_.push_back(std::move(message));
}

std::vector<std::string> Messages::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(messages_, {});
}

std::unique_lock<std::mutex> lock_loader() {
  static std::mutex mutex;
  return std::unique_lock(mutex);
}

bool has_validation_layer() {
  const auto lock = lock_loader();
  open_loader();
  return layer_is_installed();
}

// Delegates, so that the destructor cleans up when a later step throws.
Instance::Instance(Messages* messages) : Instance() {
  const auto lock = lock_loader();
  open_loader();
  if (messages && !layer_is_installed()) {
    refuse(ErrorCode::unsupported, "backend.validation-missing",
           "Validation is asked for, but the layer {} is not installed", validation_layer);
  }
  instance_ = create_instance(messages != nullptr);
  volkLoadInstanceOnly(instance_);
  if (messages) messenger_ = create_messenger(instance_, messages);
}

Instance::~Instance() {
  if (!instance_) return;
  const auto lock = lock_loader();
  volkLoadInstanceOnly(instance_);
  if (messenger_) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
  vkDestroyInstance(instance_, nullptr);
}

DeviceTraits choose_device(const Instance& instance, const std::string& filter) {
  const auto lock = lock_loader();
  const std::vector<DeviceTraits> devices = query_devices(instance.handle());
  if (devices.empty()) refuse(ErrorCode::unsupported, "backend.unavailable", "The Vulkan drivers find no device");
  bool any_suitable = false;
  for (const DeviceTraits& device : devices) {
    if (!device.has_vulkan_13 || device.queue_family < 0) continue;
    if (std::string_view(device.properties.deviceName).find(filter) != std::string_view::npos) return device;
    any_suitable = true;
  }
  if (any_suitable) {
    refuse(ErrorCode::unsupported, "backend.device", "No suitable Vulkan device is named like \"{}\"; found: {}",
           filter, names(devices));
  }
  refuse(ErrorCode::unsupported, "backend.unavailable",
         "No device offers Vulkan 1.3 with dynamic rendering and a graphics and compute queue; found: {}",
         names(devices));
}

}  // namespace relievo::vulkan
