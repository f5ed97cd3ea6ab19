/// A Job's commands on the current context.
#pragma once

#include "limits.hpp"
#include "relievo/job.hpp"
#include "relievo/result.hpp"

namespace relievo::opengl {

struct ExecutionOptions {
  Limits limits;
  bool debug = false;  ///< OpenGL's errors reach the debug output instead of failing the job
};

/// Runs a valid job to completion and deletes all that it made. JobResult::messages stays empty.
/// Errors: those of check_limits and build_programs, "backend.gl-error", "backend.framebuffer".
Result<JobResult> run_job(const Job& job, const ExecutionOptions& options);

}  // namespace relievo::opengl
