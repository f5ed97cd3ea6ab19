#include "debug_output.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace relievo::opengl {
namespace {

const char* severity_name(GLenum severity) {
  switch (severity) {
    case GL_DEBUG_SEVERITY_HIGH:
      return "high";
    case GL_DEBUG_SEVERITY_MEDIUM:
      return "medium";
    default:
      return "low";
  }
}

const char* type_name(GLenum type) {
  switch (type) {
    case GL_DEBUG_TYPE_ERROR:
      return "error";
    case GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR:
      return "deprecated behaviour";
    case GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR:
      return "undefined behaviour";
    case GL_DEBUG_TYPE_PORTABILITY:
      return "portability";
    case GL_DEBUG_TYPE_PERFORMANCE:
      return "performance";
    default:
      return "other";
  }
}

}  // namespace

DebugOutput::~DebugOutput() {
  for (const std::string& message : messages_) std::fprintf(stderr, "relievo: %s\n", message.c_str());
}

void DebugOutput::attach() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
  glDebugMessageCallback(&DebugOutput::on_message, this);
}

std::vector<std::string> DebugOutput::take() {
  return std::exchange(messages_, {});
}

void GLAPIENTRY DebugOutput::on_message(GLenum /*source*/, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                        const GLchar* message, const void* self) {
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION) return;
  std::string_view text = length >= 0 ? std::string_view(message, static_cast<std::size_t>(length)) : message;
  while (text.ends_with('\n')) text.remove_suffix(1);
  auto* output = static_cast<DebugOutput*>(const_cast<void*>(self));
  // The driver calls this from C: nothing may be thrown through it.
  try {
    output->messages_.push_back(
        fmt::format("OpenGL {} ({} severity, id {}): {}", type_name(type), severity_name(severity), id, text));
  } catch (...) {
    std::fputs("relievo: an OpenGL debug message is lost: no memory\n", stderr);
  }
}

}  // namespace relievo::opengl
