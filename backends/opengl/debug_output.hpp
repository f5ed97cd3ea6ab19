/// OpenGL's debug output as text.
#pragma once

#include <epoxy/gl.h>

#include <string>
#include <vector>

namespace relievo::opengl {

/// Collects what the driver says, notifications apart, until somebody takes it. What nobody took is printed at the end.
/// Its address is given to the driver, so it stays where it is.
class DebugOutput {
 public:
  DebugOutput() = default;
  ~DebugOutput();
  DebugOutput(const DebugOutput&) = delete;
  DebugOutput& operator=(const DebugOutput&) = delete;

  /// Listens to the current context, synchronously. The context must be a debug context.
  void attach();
  std::vector<std::string> take();

 private:
  static void GLAPIENTRY on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                    const GLchar* message, const void* self);

  std::vector<std::string> messages_;
};

}  // namespace relievo::opengl
