/// The Vulkan backend: Vulkan 1.3 with dynamic rendering and synchronization2, headless, SPIR-V in.
#include <new>

#include "device.hpp"
#include "execution.hpp"
#include "pipeline_cache.hpp"
#include "relievo/backend.hpp"

namespace relievo {

namespace vulkan {
namespace {

BackendInfo blank_info() {
  BackendInfo info;
  info.name = "vulkan";
  info.title = "Vulkan 1.3";
  info.shader_target = "spirv";
  return info;
}

bool has_memory(const VkPhysicalDeviceMemoryProperties& memory, VkMemoryPropertyFlags wanted) {
  return std::any_of(memory.memoryTypes, memory.memoryTypes + memory.memoryTypeCount,
                     [wanted](const VkMemoryType& type) { return has_all(type.propertyFlags, wanted); });
}

BackendInfo info_of(const DeviceTraits& device) {
  BackendInfo info = blank_info();
  const std::uint32_t version = device.properties.apiVersion;
  info.available = true;
  info.device = device.properties.deviceName;
  info.driver = device.driver;
  info.api_version = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                                 VK_API_VERSION_PATCH(version));
  info.features = {"compute", "depth_write", "dynamic_loops", "explicit_lod", "gather", "texture_3d", "vertex_texture"};
  if (device.features.shaderStorageImageExtendedFormats) info.features.insert("extended_images");
  if (device.features.shaderFloat64) info.features.insert("float64");
  if (device.features.geometryShader) info.features.insert("geometry");
  if (device.features.tessellationShader) info.features.insert("tessellation");
  if (device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) info.features.insert("software");
  if (device.timestamp_bits > 0) info.features.insert("timestamps");
  if (device.filters_float32) info.features.insert("linear_float32");
  if (has_memory(device.memory, shared_with_host)) info.features.insert("shared_memory");
  if (has_validation_layer()) info.features.insert("validation");
  info.max_storage_buffer = device.properties.limits.maxStorageBufferRange;
  return info;
}

BackendInfo probe() try {
  const Instance instance(nullptr);
  return info_of(choose_device(instance, ""));
} catch (const Failure& failure) {
  BackendInfo info = blank_info();
  info.reason = failure.error.message;
  return info;
}

class VulkanBackend final : public Backend {
 public:
  explicit VulkanBackend(const BackendOptions& options)
      : device_(options), cache_(device_, options.pipeline_cache), info_(info_of(device_.traits())) {}

  const BackendInfo& info() const override { return info_; }

  Result<JobResult> execute(const Job& job) override {
    return keep_read_backs([&](const TakeReadBack& keep) {
      return run(
          job, [] {}, keep);
    });
  }
  Result<JobResult> execute_once(Job job, const TakeReadBack& take) override {
    return run(
        job, [&job] { free_contents(job); }, take);
  }

 private:
  Result<JobResult> run(const Job& job, const std::function<void()>& uploaded, const TakeReadBack& take) try {
    if (const Status valid = validate_job(job); !valid) return tl::unexpected(valid.error());
    JobResult result = run_job(device_, job, cache_.handle(), programs_, uploaded, take);
    const std::string cache_problem = cache_.save();
    result.messages = device_.messages().take();
    if (!cache_problem.empty()) result.messages.push_back(cache_problem);
    return result;
  } catch (const Failure& failure) {
    return refusal(job, failure.error);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::backend, "backend.out-of-memory", fmt::format("Job \"{}\": out of memory", job.name));
  }

  /// The failure with the job's name, and with what the validation layer said, which may be its cause.
  tl::unexpected<Error> refusal(const Job& job, Error error) {
    error.message = fmt::format("Job \"{}\": {}", job.name, error.message);
    for (const std::string& message : device_.messages().take()) error.message += "; " + message;
    return tl::unexpected(std::move(error));
  }

  Device device_;
  PipelineCache cache_;
  RecentPrograms<DeviceProgram> programs_;
  BackendInfo info_;
};

Result<std::unique_ptr<Backend>> open(const BackendOptions& options) try {
  return std::make_unique<VulkanBackend>(options);
} catch (const Failure& failure) {
  return tl::unexpected(failure.error);
}

}  // namespace
}  // namespace vulkan

namespace backends {
extern const BackendFactory vulkan_factory;
const BackendFactory vulkan_factory = {"vulkan", vulkan::probe, vulkan::open};
}  // namespace backends

}  // namespace relievo
