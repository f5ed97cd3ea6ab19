/// One Draw: framebuffer, vertex input, fixed-function state.
#pragma once

#include "programs.hpp"
#include "relievo/job.hpp"
#include "relievo/result.hpp"
#include "resources.hpp"

namespace relievo::opengl {

/// The program is in use and its resources are bound. Error: "backend.framebuffer" when the driver cannot draw to these
/// targets together.
Status run_draw(const Job& job, const Resources& resources, const Program& program, const Draw& draw);

}  // namespace relievo::opengl
