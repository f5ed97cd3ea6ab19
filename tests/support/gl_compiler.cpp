#include "support/gl_compiler.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

namespace relievo::testing {

namespace {

constexpr EGLint kDesktop[] = {
    EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
constexpr EGLint kEmbedded[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2, EGL_NONE};

GLenum gl_stage(ShaderStage stage) {
  constexpr GLenum kStages[] = {GL_VERTEX_SHADER,   GL_TESS_CONTROL_SHADER, GL_TESS_EVALUATION_SHADER,
                                GL_GEOMETRY_SHADER, GL_FRAGMENT_SHADER,     GL_COMPUTE_SHADER};
  return kStages[static_cast<int>(stage)];
}

std::string shader_log(GLuint shader) {
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

std::string program_log(GLuint program) {
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

/// Compiles one text and attaches it; the driver's log on failure.
std::string attach(GLuint program, ShaderStage stage, const std::string& text) {
  const GLuint shader = glCreateShader(gl_stage(stage));
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  std::string log;
  if (compiled != GL_TRUE) log = fmt::format("{}: {}\n{}", to_string(stage), shader_log(shader), text);
  glAttachShader(program, shader);
  glDeleteShader(shader);
  return log;
}

bool is_found(GLuint program, const BindingSlot& slot) {
  switch (slot.kind) {
    case ResourceKind::uniform_buffer:
      return glGetUniformBlockIndex(program, slot.name.c_str()) != GL_INVALID_INDEX;
    case ResourceKind::storage_buffer:
      return glGetProgramResourceIndex(program, GL_SHADER_STORAGE_BLOCK, slot.name.c_str()) != GL_INVALID_INDEX;
    default:
      return glGetUniformLocation(program, slot.name.c_str()) >= 0;
  }
}

std::string link(GLuint program, const Target& target, const CompiledProgram& compiled) {
  for (const CompiledShader& shader : compiled.shaders) {
    std::string log = attach(program, shader.stage, shader.text.at(to_string(target)));
    if (!log.empty()) return log;
  }
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) return "link: " + program_log(program);
  for (const BindingSlot& slot : compiled.bindings) {
    if (!is_found(program, slot)) return fmt::format("{} '{}' is not in the program", to_string(slot.kind), slot.name);
  }
  return {};
}

}  // namespace

std::unique_ptr<GlCompiler> GlCompiler::create(Language language, std::string& reason) {
  EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    reason = "EGL has no surfaceless display";
    return nullptr;
  }
  const bool desktop = language == Language::glsl;
  eglBindAPI(desktop ? EGL_OPENGL_API : EGL_OPENGL_ES_API);
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, desktop ? kDesktop : kEmbedded);
  if (context == EGL_NO_CONTEXT || eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
    reason = fmt::format("no context: EGL error {:#x}", eglGetError());
    return nullptr;
  }
  return std::unique_ptr<GlCompiler>(new GlCompiler(display, context));
}

GlCompiler::~GlCompiler() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

std::string GlCompiler::check(const Target& target, const CompiledProgram& program) {
  const GLuint gl_program = glCreateProgram();
  std::string reason = link(gl_program, target, program);
  glDeleteProgram(gl_program);
  return reason.empty() ? reason : fmt::format("{} {}", to_string(target), reason);
}

}  // namespace relievo::testing
