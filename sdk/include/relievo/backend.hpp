/// Backends turn a Job into results; each is one folder of backends/.
/// Every free function here is thread-safe; a Backend is not.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/job.hpp"
#include "relievo/result.hpp"

namespace relievo {

/// What a backend found on this machine.
struct BackendInfo {
  std::string name;   ///< "vulkan"
  std::string title;  ///< "Vulkan 1.3"
  bool available = false;
  std::string reason;  ///< why it is not available: one sentence
  std::string device, driver, api_version;
  std::string shader_target;  ///< what it consumes: "spirv", "glsl-450"
  /// Names of the shader-model features of descriptors ("compute", "geometry", "explicit_lod", "texture_3d", "gather",
  /// "vertex_texture") and of abilities ("timestamps", "linear_float32", "float64", "shared_memory", "validation"), or
  /// "software" for a driver that runs on the CPU.
  std::set<std::string> features;
  std::size_t max_storage_buffer = 0;  ///< bytes that a shader can reach in one; 0: no limit is known
};

struct BackendOptions {
  bool validation = false;     ///< Vulkan validation layer, OpenGL debug output: reported in JobResult::messages
  std::string device;          ///< substring of the device to use; empty = the first suitable one
  std::string pipeline_cache;  ///< file of the Vulkan pipeline cache, read and written; empty = none
  bool copies_always = false;  ///< Vulkan copies buffers to and from the device even where both share their memory
  int fail_at_call = -1;       ///< null backend only: this call (0-based) fails
};

/// Gets a read-back, by its place in Job::read_backs; the bytes are there during the call only.
using TakeReadBack = std::function<void(std::size_t index, std::span<const std::byte> bytes)>;

/// Executes Jobs. One object is used from one thread at a time.
class Backend {
 public:
  virtual ~Backend() = default;
  virtual const BackendInfo& info() const = 0;  ///< thread-safe
  /// Runs the job to completion. Errors: "job.*" for a Job that is not valid, "backend.*" when the API refuses.
  /// Nothing of the job outlives the call but its programs as the driver has compiled them: the last 16 are kept, for
  /// jobs with the same.
  virtual Result<JobResult> execute(const Job& job) = 0;
  /// The same with as little memory as may be, for a job that is not needed again: its contents may be freed once the
  /// device has them, and each read-back is handed to `take`, in order, instead of being kept in the result.
  virtual Result<JobResult> execute_once(Job job, const TakeReadBack& take);
};

/// For backends that run every job as execute_once does: runs with a taker that keeps the read-backs in the result.
Result<JobResult> keep_read_backs(const std::function<Result<JobResult>(const TakeReadBack& keep)>& run);

/// What a backend folder provides: `extern const BackendFactory relievo::backends::<folder name>_factory;`
struct BackendFactory {
  const char* name;
  BackendInfo (*probe)();
  Result<std::unique_ptr<Backend>> (*open)(const BackendOptions& options);
};

/// Probes every backend built into the library; the unavailable ones say why.
std::vector<BackendInfo> list_backends();

/// Opens a backend by name. Errors: unknown name (the nearest known one is named; "backend.unknown"),
/// no driver ("backend.unavailable", ErrorCode::unsupported).
Result<std::unique_ptr<Backend>> open_backend(std::string_view name, const BackendOptions& options = {});

}  // namespace relievo
