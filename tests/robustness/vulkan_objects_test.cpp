/// Every object that the program makes on a Vulkan device is destroyed before the device, as the validation layer sees
/// it; without a messenger of ours it speaks on stdout.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vulkan/vulkan.h>

#include <string>
#include <vector>

#include "relievo/image.hpp"
#include "support/child.hpp"
#include "support/height_maps.hpp"

namespace relievo::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* layers = "VK_INSTANCE_LAYERS";
constexpr const char* layer = "VK_LAYER_KHRONOS_validation";
constexpr const char* scene = RELIEVO_SOURCE_DIR "/examples/scenes/plane.toml";

/// The Vulkan loader, which applications link or open.
template <class Function>
Function loaded(const char* name) {
  static void* const loader = dlopen("libvulkan.so.1", RTLD_NOW);
  return reinterpret_cast<Function>(dlsym(loader, name));
}

/// Makes a device and a fence, and destroys the device.
void forget_a_fence() {
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo instance_info{};
  instance_info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  instance_info.pApplicationInfo = &application;
  VkInstance instance = nullptr;
  ASSERT_EQ(loaded<PFN_vkCreateInstance>("vkCreateInstance")(&instance_info, nullptr, &instance), VK_SUCCESS);
  std::uint32_t count = 1;
  VkPhysicalDevice physical = nullptr;
  loaded<PFN_vkEnumeratePhysicalDevices>("vkEnumeratePhysicalDevices")(instance, &count, &physical);
  ASSERT_EQ(count, 1u);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo device_info{};
  device_info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  device_info.queueCreateInfoCount = 1;
  device_info.pQueueCreateInfos = &queue;
  VkDevice device = nullptr;
  ASSERT_EQ(loaded<PFN_vkCreateDevice>("vkCreateDevice")(physical, &device_info, nullptr, &device), VK_SUCCESS);
  VkFenceCreateInfo fence_info{};
  fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  VkFence fence = VK_NULL_HANDLE;
  ASSERT_EQ(loaded<PFN_vkCreateFence>("vkCreateFence")(device, &fence_info, nullptr, &fence), VK_SUCCESS);
  loaded<PFN_vkDestroyDevice>("vkDestroyDevice")(device, nullptr);
  loaded<PFN_vkDestroyInstance>("vkDestroyInstance")(instance, nullptr);
}

TEST(VulkanObjects, AForgottenOneIsSaid) {
  ::setenv(layers, layer, 1);
  ::testing::internal::CaptureStdout();
  forget_a_fence();
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("VkFence"));
  ::unsetenv(layers);
}

TEST(VulkanObjects, AllAreDestroyedAfterDrawsAndDispatches) {
  const TemporaryFolder folder;
  const HeightMap map = checker_map(16, 16);
  const std::string height = (folder / "height.pfm").string(), out = (folder / "out.png").string(),
                    rays = (folder / "rays.csv").string(), baked = (folder / "map.exr").string();
  ASSERT_TRUE(write_pfm(height, Image{map.width, map.height, 1, map.texels}));
  folder.write("rays.csv", "u,v,h,du,dv,dh\n0.5,0.5,1,0,0,-1\n");
  const std::vector<std::vector<std::string>> runs = {
      {"render", scene, "--technique", "relief", "--stage", "surface", "-o", out},
      {"render", scene, "--technique", "quadrant_maxima", "--stage", "prism", "-o", out},
      {"render", scene, "--stage", "vertex", "-o", out},
      {"trace", "--technique", "pyramid_3d", "--height", height, "--rays", rays},
      {"bake", "directional_cone", "--height", height, "-o", baked}};
  for (const std::vector<std::string>& words : runs) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--backend", "vulkan"});
    const ChildResult result = run_relievo(all, {{layers, layer}});
    EXPECT_EQ(result.exit_code, 0) << words[0] << ": " << result.err;
    EXPECT_THAT(result.out + result.err, Not(HasSubstr("VUID"))) << words[0] << " " << words[3];
  }
}

}  // namespace
}  // namespace relievo::test
