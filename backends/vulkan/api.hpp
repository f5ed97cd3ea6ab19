/// Vulkan's functions, owned handles and failures. Inside this folder a failure is an exception; the functions of
/// BackendFactory and Backend turn it into an Error.
#pragma once

#define VK_NO_PROTOTYPES
#include <fmt/format.h>
#include <volk.h>

#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "relievo/result.hpp"

namespace relievo::vulkan {

struct Failure {
  Error error;
};

template <class... Args>
[[noreturn]] void refuse(ErrorCode code, const char* id, fmt::format_string<Args...> sentence, Args&&... args) {
  throw Failure{Error{code, id, fmt::format(sentence, std::forward<Args>(args)...), {}, 0, 0}};
}

/// Throws a Failure that says what failed ("creating buffer \"rays\"") unless the result is VK_SUCCESS.
void check(VkResult result, std::string_view what);

template <class Handle>
struct Destroy {
  VkDevice device = VK_NULL_HANDLE;
  void(VKAPI_PTR* function)(VkDevice, Handle, const VkAllocationCallbacks*) = nullptr;

  void operator()(Handle handle) const { function(device, handle, nullptr); }
};

/// A device object that is destroyed with its owner.
template <class Handle>
using Unique = std::unique_ptr<std::remove_pointer_t<Handle>, Destroy<Handle>>;

}  // namespace relievo::vulkan
