/// A Job's commands on the current context.
#pragma once

#include <functional>

#include "job/recent_programs.hpp"
#include "limits.hpp"
#include "programs.hpp"
#include "relievo/backend.hpp"
#include "relievo/result.hpp"

namespace relievo::opengl {

struct ExecutionOptions {
  Limits limits;
  bool debug = false;  ///< OpenGL's errors reach the debug output instead of failing the job
};

/// Runs a valid job to completion, hands over what it reads back and deletes all that it made but the programs, which
/// `recent` keeps; the result has the times alone. Calls `uploaded` once the job's contents are not needed any more.
/// Errors: those of check_limits and build_programs, "backend.gl-error", "backend.framebuffer".
Result<JobResult> run_job(const Job& job, const ExecutionOptions& options, RecentPrograms<Program>& recent,
                          const std::function<void()>& uploaded, const TakeReadBack& take);

}  // namespace relievo::opengl
