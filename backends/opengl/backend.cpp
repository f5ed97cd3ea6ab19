/// The OpenGL backend: OpenGL 4.5 core through EGL without a window system; it runs the emitted GLSL 4.50.
#include "relievo/backend.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <new>
#include <utility>

#include "context.hpp"
#include "execution.hpp"

namespace relievo {
namespace opengl {
namespace {

BackendInfo named_info() {
  BackendInfo info;
  info.name = "opengl";
  info.title = "OpenGL 4.5";
  info.shader_target = "glsl-450";
  return info;
}

/// Asks the current context, which is at least 4.5: there, all but the clock is core.
BackendInfo read_info(const Limits& limits, bool is_software) {
  BackendInfo info = named_info();
  info.available = true;
  info.device = gl_string(GL_RENDERER);
  info.driver = gl_string(GL_VENDOR);
  info.api_version = gl_string(GL_VERSION);
  info.features = {"compute",     "geometry",       "tessellation",   "explicit_lod",
                   "texture_3d",  "gather",         "vertex_texture", "dynamic_loops",
                   "depth_write", "linear_float32", "validation",     "extended_images"};
  if (is_software) info.features.insert("software");
  if (limits.timestamp_bits > 0) info.features.insert("timestamps");
  info.max_storage_buffer = static_cast<std::size_t>(limits.storage_block_size);
  return info;
}

class OpenGlBackend final : public Backend {
 public:
  static Result<std::unique_ptr<Backend>> open(const BackendOptions& options) {
    auto context = Context::open(options);
    if (!context) return tl::unexpected(std::move(context.error()));
    const CurrentContext current(**context);
    if (!current.status()) return tl::unexpected(current.status().error());
    return std::make_unique<OpenGlBackend>(std::move(*context));
  }

  /// `context` is current.
  explicit OpenGlBackend(std::unique_ptr<Context> context)
      : context_(std::move(context)),
        options_{query_limits(), context_->debug()},
        info_(read_info(options_.limits, context_->is_software())) {}

  ~OpenGlBackend() override {
    const CurrentContext current(*context_);
    programs_.clear();
  }
  OpenGlBackend(const OpenGlBackend&) = delete;
  OpenGlBackend& operator=(const OpenGlBackend&) = delete;

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
  Result<JobResult> run(const Job& job, const std::function<void()>& uploaded, const TakeReadBack& take) {
    if (auto status = validate_job(job); !status) return tl::unexpected(std::move(status.error()));
    const CurrentContext current(*context_);
    if (!current.status()) return tl::unexpected(current.status().error());
    auto result = run_within_memory(job, uploaded, take);
    add_messages(result);
    return result;
  }

  Result<JobResult> run_within_memory(const Job& job, const std::function<void()>& uploaded,
                                      const TakeReadBack& take) try {
    return run_job(job, options_, programs_, uploaded, take);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::backend, "backend.memory", fmt::format("job '{}' does not fit into memory", job.name));
  }

  /// A job that failed tells its debug output in the error, where its result cannot.
  void add_messages(Result<JobResult>& result) {
    auto messages = context_->debug_output().take();
    if (result) {
      result->messages = std::move(messages);
    } else if (!messages.empty()) {
      result.error().message += fmt::format("; debug output: {}", fmt::join(messages, "; "));
    }
  }

  std::unique_ptr<Context> context_;
  RecentPrograms<Program> programs_;
  ExecutionOptions options_;
  BackendInfo info_;
};

Result<std::unique_ptr<Backend>> open_opengl(const BackendOptions& options) {
  return OpenGlBackend::open(options);
}

BackendInfo probe_opengl() {
  auto backend = OpenGlBackend::open({});
  if (backend) return (*backend)->info();
  BackendInfo info = named_info();
  info.reason = backend.error().message;
  return info;
}

}  // namespace
}  // namespace opengl

namespace backends {

extern const BackendFactory opengl_factory;
const BackendFactory opengl_factory = {"opengl", &opengl::probe_opengl, &opengl::open_opengl};

}  // namespace backends
}  // namespace relievo
