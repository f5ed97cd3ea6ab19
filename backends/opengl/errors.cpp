#include "errors.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

namespace relievo::opengl {
namespace {

std::string error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST";
    default:
      return fmt::format("error 0x{:x}", error);
  }
}

}  // namespace

Status check_gl(const std::string& what) {
  const GLenum first = glGetError();
  if (first == GL_NO_ERROR) return {};
  // There are only a few flags; a lost context gives its error for ever.
  for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
  }
  return fail(ErrorCode::backend, "backend.gl-error",
              fmt::format("{}: OpenGL reports {}, expected none", what, error_name(first)));
}

}  // namespace relievo::opengl
