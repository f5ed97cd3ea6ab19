/// The Job's programs, compiled by the driver from their emitted GLSL.
#pragma once

#include <memory>
#include <vector>

#include "handles.hpp"
#include "job/recent_programs.hpp"
#include "relievo/job.hpp"
#include "relievo/result.hpp"

namespace relievo::opengl {

struct Program {
  ProgramHandle handle;
  bool tessellated = false;
};

/// Compiles and links; every resource sits in the slot that the program's contract says, whether or not the text has
/// layout(binding = …). Errors: "job.no-shader-text", "backend.glsl-compile" with the driver's log, and
/// "backend.binding-contract" for a resource that the shaders use and the contract lacks.
Result<Program> build_program(const ShaderProgram& program);

/// Builds those that are not kept in `recent`, which keeps them then.
Result<std::vector<std::shared_ptr<Program>>> build_programs(const Job& job, RecentPrograms<Program>& recent);

}  // namespace relievo::opengl
