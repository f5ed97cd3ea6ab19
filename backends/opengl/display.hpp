/// EGL displays without windows: Mesa's surfaceless platform, then one display a device (NVIDIA's headless driver).
#pragma once

#include <epoxy/egl.h>

#include <string>
#include <vector>

#include "relievo/result.hpp"

namespace relievo::opengl {

/// A display that can be tried, not initialised yet.
struct DisplayCandidate {
  EGLDisplay handle = EGL_NO_DISPLAY;
  std::string label;  ///< "surfaceless", "device 0"
};

/// In the order to try. Call only when missing_driver_library() is empty. Empty when EGL knows no headless platform.
std::vector<DisplayCandidate> display_candidates();

/// The display stays initialised until the process ends: EGL counts no references, so terminating it would destroy the
/// contexts that the application made on the same one; and drivers that are unloaded leave memory behind.
/// Error: "backend.unavailable".
Status initialise(const DisplayCandidate& candidate);

bool has_extension(EGLDisplay display, const char* name);

/// The name of an EGL error: "EGL_BAD_MATCH".
std::string egl_error_name(EGLint error);

}  // namespace relievo::opengl
