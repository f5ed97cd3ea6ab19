#include "execution.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "draw.hpp"
#include "errors.hpp"
#include "programs.hpp"
#include "resources.hpp"
#include "timers.hpp"

namespace relievo::opengl {
namespace {

void bind_resources(const Job& job, const Resources& resources, int program,
                    const std::vector<ResourceBinding>& bindings) {
  for (const BindingSlot& slot : job.programs[program].bindings) {
    for (const ResourceBinding& binding : bindings) {
      if (binding.set == slot.set && binding.binding == slot.binding) {
        bind_resource(job, resources, slot, binding.resource);
      }
    }
  }
}

Status run_dispatch(const Dispatch& dispatch) {
  glDispatchCompute(dispatch.groups[0], dispatch.groups[1], dispatch.groups[2]);
  return {};
}

Status run_command(const Job& job, const std::vector<std::shared_ptr<Program>>& programs, const Resources& resources,
                   const Command& command, CommandTimers& timers) {
  const auto* dispatch = std::get_if<Dispatch>(&command);
  const auto* draw = std::get_if<Draw>(&command);
  const int index = dispatch != nullptr ? dispatch->program : draw->program;
  bind_resources(job, resources, index, dispatch != nullptr ? dispatch->resources : draw->resources);
  glUseProgram(programs[index]->handle.get());
  timers.begin_command();
  auto status = dispatch != nullptr ? run_dispatch(*dispatch) : run_draw(job, resources, *programs[index], *draw);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  timers.end_command();
  glUseProgram(0);  // a program in use is not deleted
  return status;
}

/// Nobody hears of an OpenGL error twice: a debug context has told its debug output already.
Status check(const std::string& what, bool debug) {
  auto status = check_gl(what);
  return debug ? Status{} : status;
}

Status run_commands(const Job& job, const std::vector<std::shared_ptr<Program>>& programs, const Resources& resources,
                    bool debug, CommandTimers& timers) {
  int number = 0;
  for (const Command& command : job.commands) {
    const std::string what = fmt::format("job '{}', command {}", job.name, number++);
    if (auto status = run_command(job, programs, resources, command, timers); !status) {
      status.error().message = fmt::format("{}: {}", what, status.error().message);
      return status;
    }
    if (auto status = check(what, debug); !status) return status;
  }
  return {};
}

}  // namespace

Result<JobResult> run_job(const Job& job, const ExecutionOptions& options, RecentPrograms<Program>& recent,
                          const std::function<void()>& uploaded, const TakeReadBack& take) {
  if (auto status = check_limits(job, options.limits); !status) return tl::unexpected(std::move(status.error()));
  const auto programs = build_programs(job, recent);
  if (!programs) return tl::unexpected(programs.error());
  const Resources resources = upload_resources(job);
  if (auto status = check(fmt::format("While uploading job '{}'", job.name), options.debug); !status) {
    return tl::unexpected(std::move(status.error()));
  }
  uploaded();
  CommandTimers timers(options.limits.timestamp_bits > 0);
  if (auto status = run_commands(job, *programs, resources, options.debug, timers); !status) {
    return tl::unexpected(std::move(status.error()));
  }
  JobResult result;
  for (std::size_t i = 0; i < job.read_backs.size(); ++i) take(i, read_back(job, resources, job.read_backs[i]));
  result.command_seconds = timers.seconds();
  if (auto status = check(fmt::format("While reading back job '{}'", job.name), options.debug); !status) {
    return tl::unexpected(std::move(status.error()));
  }
  return result;
}

}  // namespace relievo::opengl
