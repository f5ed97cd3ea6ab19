#include <dlfcn.h>

// Ours alone: a program that uses volk too has its own.
#pragma GCC visibility push(hidden)
#define VK_NO_PROTOTYPES
#define VOLK_IMPLEMENTATION
#include <volk.h>
#pragma GCC visibility pop

#include "api.hpp"

namespace relievo::vulkan {

namespace {

std::string name_of(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
      return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_INVALID_SHADER_NV:
      return "VK_ERROR_INVALID_SHADER_NV";
    default:
      return fmt::format("VkResult {}", static_cast<int>(result));
  }
}

const char* id_of(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "backend.out-of-memory";
    case VK_ERROR_DEVICE_LOST:
      return "backend.device-lost";
    default:
      return "backend.vulkan";
  }
}

}  // namespace

void check(VkResult result, std::string_view what) {
  if (result == VK_SUCCESS) return;
  refuse(ErrorCode::backend, id_of(result), "{} fails with {}", what, name_of(result));
}

}  // namespace relievo::vulkan
