/// EGL displays without windows: Mesa's surfaceless platform, then one display a device (NVIDIA's headless driver).
#pragma once

#include <epoxy/egl.h>

#include <memory>
#include <string>
#include <vector>

#include "relievo/result.hpp"

namespace relievo::opengl {

/// An initialised display. EGL itself counts no references, so this class does: the last object of a display terminates
/// it, unless the application had initialised it before us.
class Display {
 public:
  /// Errors: "backend.unavailable".
  static Result<std::unique_ptr<Display>> open(EGLDisplay handle, const std::string& label);
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  EGLDisplay handle() const { return handle_; }
  bool has_extension(const char* name) const;

 private:
  explicit Display(EGLDisplay handle) : handle_(handle) {}

  EGLDisplay handle_;
};

/// A display that can be tried, not initialised yet.
struct DisplayCandidate {
  EGLDisplay handle = EGL_NO_DISPLAY;
  std::string label;  ///< "surfaceless", "device 0"
};

/// In the order to try. Call only when missing_driver_library() is empty. Empty when EGL knows no headless platform.
std::vector<DisplayCandidate> display_candidates();

/// The name of an EGL error: "EGL_BAD_MATCH".
std::string egl_error_name(EGLint error);

}  // namespace relievo::opengl
