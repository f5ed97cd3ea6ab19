/// An OpenGL 4.5 core context without a window, and the scope in which it is current.
#pragma once

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <memory>
#include <string>

#include "debug_output.hpp"
#include "display.hpp"
#include "relievo/backend.hpp"
#include "relievo/result.hpp"

namespace relievo::opengl {

class Context {
 public:
  /// Opens the first display whose driver has OpenGL 4.5 and whose renderer's name contains `options.device`;
  /// among several, hardware before software. Errors: "backend.unavailable", "backend.unknown-device".
  static Result<std::unique_ptr<Context>> open(const BackendOptions& options);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  bool debug() const { return debug_; }
  DebugOutput& debug_output() { return debug_output_; }
  const std::string& device() const { return device_; }
  /// The renderer runs on the CPU (llvmpipe, softpipe).
  bool is_software() const;

 private:
  friend class CurrentContext;
  static Result<std::unique_ptr<Context>> create(const DisplayCandidate& candidate, bool debug);
  Context() = default;
  Status create_handle(const DisplayCandidate& candidate);
  Status read_identity(const DisplayCandidate& candidate);

  DebugOutput debug_output_;  // outlives the context, which speaks to it while it is destroyed
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext handle_ = EGL_NO_CONTEXT;
  bool debug_ = false;
  std::string device_;
};

/// Makes the context current on this thread; afterwards the application's own context, if it had one, is back.
class CurrentContext {
 public:
  explicit CurrentContext(const Context& context);
  ~CurrentContext();
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

  /// Error "backend.make-current" when EGL refused, for instance because another thread has the context.
  const Status& status() const { return status_; }

 private:
  EGLDisplay display_;
  EGLenum previous_api_;
  EGLDisplay previous_display_;
  EGLSurface previous_draw_, previous_read_;
  EGLContext previous_context_;
  Status status_;
};

/// glGetString of the current context; empty where it has none.
std::string gl_string(GLenum name);

}  // namespace relievo::opengl
