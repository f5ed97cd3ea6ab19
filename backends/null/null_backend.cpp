#include "null_backend.hpp"

#include <fmt/format.h>

#include <new>

namespace relievo {

namespace {

BackendInfo null_info() {
  BackendInfo info;
  info.name = "null";
  info.title = "Null: records calls, computes nothing";
  info.available = true;
  info.device = "none";
  info.driver = "none";
  info.api_version = "1";
  info.shader_target = "spirv";
  info.features = {"compute",  "depth_write",  "dynamic_loops", "explicit_lod",   "gather",
                   "geometry", "tessellation", "texture_3d",    "vertex_texture", "extended_images"};
  return info;
}

Result<std::unique_ptr<Backend>> open_null(const BackendOptions& options) {
  return std::make_unique<NullBackend>(options);
}

}  // namespace

/// One execution. Its objects die with it, however it ends.
class NullBackend::Run {
 public:
  Run(NullBackend& backend, const Job& job) : backend_(backend), job_(job) {}
  ~Run() { backend_.live_objects_ -= created_; }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  Result<JobResult> execute() {
    return create_objects().and_then([this] { return record_commands(); }).and_then([this] { return read_back(); });
  }

 private:
  Status call(std::string line) {
    const auto index = static_cast<int>(backend_.log_.size());
    backend_.log_.push_back(std::move(line));
    if (index != backend_.fail_at_call_) return {};
    return fail(ErrorCode::backend, "backend.injected",
                fmt::format("Job \"{}\": call {} ({}) fails as BackendOptions::fail_at_call asks", job_.name, index,
                            backend_.log_.back()));
  }

  Status create(std::string line) {
    Status status = call("create " + std::move(line));
    if (!status) return status;
    ++created_;
    ++backend_.live_objects_;
    return {};
  }

  Status create_objects() {
    Status status;
    for (std::size_t i = 0; i < job_.programs.size() && status; ++i) {
      status = create(fmt::format("program \"{}\"", job_.programs[i].name));
    }
    for (std::size_t i = 0; i < job_.buffers.size() && status; ++i) {
      status = create(fmt::format("buffer \"{}\" of {} bytes", job_.buffers[i].name, job_.buffers[i].size));
    }
    for (std::size_t i = 0; i < job_.textures.size() && status; ++i) {
      const Texture& texture = job_.textures[i];
      status = create(fmt::format("texture \"{}\" of {}x{}x{} {}, {} levels", texture.name, texture.width,
                                  texture.height, texture.depth, to_string(texture.format), texture.levels));
    }
    return status;
  }

  std::string describe(const Dispatch& dispatch) const {
    return fmt::format("dispatch \"{}\" {}x{}x{}", program_name(dispatch.program), dispatch.groups[0],
                       dispatch.groups[1], dispatch.groups[2]);
  }

  std::string describe(const Draw& draw) const {
    return fmt::format("draw \"{}\" {} vertices, {} instances", program_name(draw.program), draw.count, draw.instances);
  }

  Status record_commands() {
    Status status;
    for (std::size_t i = 0; i < job_.commands.size() && status; ++i) {
      status = call(std::visit([this](const auto& command) { return describe(command); }, job_.commands[i]));
    }
    return status;
  }

  Result<JobResult> read_back() {
    JobResult result;
    for (const ReadBack& source : job_.read_backs) {
      const auto index = static_cast<std::size_t>(source.index);
      const bool is_buffer = source.source == ReadBack::Source::buffer;
      const Status status =
          call(is_buffer ? fmt::format("read back buffer \"{}\"", job_.buffers[index].name)
                         : fmt::format("read back texture \"{}\" level {}", job_.textures[index].name, source.level));
      if (!status) return tl::unexpected(status.error());
      result.read_backs.emplace_back(is_buffer ? job_.buffers[index].size
                                               : level_size(job_.textures[index], source.level));
    }
    return result;
  }

  const std::string& program_name(int program) const { return job_.programs[static_cast<std::size_t>(program)].name; }

  NullBackend& backend_;
  const Job& job_;
  int created_ = 0;
};

NullBackend::NullBackend(const BackendOptions& options) : info_(null_info()), fail_at_call_(options.fail_at_call) {}

Result<JobResult> NullBackend::execute(const Job& job) try {
  if (const Status valid = validate_job(job); !valid) return tl::unexpected(valid.error());
  return Run(*this, job).execute();
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::backend, "backend.out-of-memory",
              fmt::format("Job \"{}\": the read-backs do not fit in memory", job.name));
}

namespace backends {
extern const BackendFactory null_factory;
const BackendFactory null_factory = {"null", null_info, open_null};
}  // namespace backends

}  // namespace relievo
