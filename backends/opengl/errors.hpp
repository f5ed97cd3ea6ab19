/// OpenGL's error flags as errors of ours.
#pragma once

#include <string>

#include "relievo/result.hpp"

namespace relievo::opengl {

/// Empties the error flags of the current context. Error "backend.gl-error", naming `what` and the first flag.
Status check_gl(const std::string& what);

}  // namespace relievo::opengl
