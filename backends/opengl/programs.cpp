#include "programs.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "program_interface.hpp"
#include "specialization.hpp"
#include "vertex_order.hpp"

namespace relievo::opengl {
namespace {

GLenum shader_type(ShaderStage stage) {
  switch (stage) {
    case ShaderStage::vertex:
      return GL_VERTEX_SHADER;
    case ShaderStage::tessellation_control:
      return GL_TESS_CONTROL_SHADER;
    case ShaderStage::tessellation_evaluation:
      return GL_TESS_EVALUATION_SHADER;
    case ShaderStage::geometry:
      return GL_GEOMETRY_SHADER;
    case ShaderStage::fragment:
      return GL_FRAGMENT_SHADER;
    case ShaderStage::compute:
      return GL_COMPUTE_SHADER;
  }
  return GL_NONE;
}

/// `get` is glGetShaderInfoLog or glGetProgramInfoLog.
template <class Get>
std::string info_log(GLuint name, GLint length, Get get) {
  std::string log(static_cast<std::size_t>(length > 0 ? length : 0), '\0');
  GLsizei written = 0;
  get(name, length, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  while (!log.empty() && (log.back() == '\n' || log.back() == ' ')) log.pop_back();
  return log.empty() ? "the driver gives no log" : log;
}

Result<ShaderHandle> compile_shader(const ShaderProgram& program, const ShaderCode& code) {
  const auto text = code.text.find("glsl-450");
  if (text == code.text.end()) {
    return fail(ErrorCode::usage, "job.no-shader-text",
                fmt::format("the {} shader of program '{}' has no text for glsl-450, which the opengl backend runs",
                            to_string(code.stage), program.name));
  }
  std::string source = specialize(text->second, program.constants);
  if (code.stage == ShaderStage::tessellation_evaluation) source = exchange_vertex_order(source);
  ShaderHandle shader(glCreateShader(shader_type(code.stage)));
  const GLchar* pointer = source.data();
  const auto length = static_cast<GLint>(source.size());
  glShaderSource(shader.get(), 1, &pointer, &length);
  glCompileShader(shader.get());
  GLint compiled = GL_FALSE, log_length = 0;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  glGetShaderiv(shader.get(), GL_INFO_LOG_LENGTH, &log_length);
  return fail(ErrorCode::compile, "backend.glsl-compile",
              fmt::format("the OpenGL driver does not compile the {} shader of program '{}': {}", to_string(code.stage),
                          program.name, info_log(shader.get(), log_length, glGetShaderInfoLog)));
}

Status link(const ShaderProgram& program, GLuint name) {
  glLinkProgram(name);
  GLint linked = GL_FALSE, log_length = 0;
  glGetProgramiv(name, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return {};
  glGetProgramiv(name, GL_INFO_LOG_LENGTH, &log_length);
  return fail(ErrorCode::compile, "backend.glsl-compile",
              fmt::format("the OpenGL driver does not link program '{}': {}", program.name,
                          info_log(name, log_length, glGetProgramInfoLog)));
}

}  // namespace

Result<Program> build_program(const ShaderProgram& program) {
  Program result{ProgramHandle(glCreateProgram()), false};
  std::vector<ShaderHandle> shaders;  // deleted once the program is linked
  for (const ShaderCode& code : program.shaders) {
    auto shader = compile_shader(program, code);
    if (!shader) return tl::unexpected(std::move(shader.error()));
    glAttachShader(result.handle.get(), shader->get());
    shaders.push_back(std::move(*shader));
    result.tessellated |= code.stage == ShaderStage::tessellation_evaluation;
  }
  if (auto status = link(program, result.handle.get()); !status) return tl::unexpected(std::move(status.error()));
  for (const ShaderHandle& shader : shaders) glDetachShader(result.handle.get(), shader.get());
  assign_slots(program, result.handle.get());
  if (auto status = check_contract(program, result.handle.get()); !status) {
    return tl::unexpected(std::move(status.error()));
  }
  return result;
}

Result<std::vector<std::shared_ptr<Program>>> build_programs(const Job& job, RecentPrograms<Program>& recent) {
  std::vector<std::shared_ptr<Program>> programs;
  for (const ShaderProgram& description : job.programs) {
    if (auto kept = recent.find(description)) {
      programs.push_back(std::move(kept));
      continue;
    }
    auto program = build_program(description);
    if (!program) return tl::unexpected(std::move(program.error()));
    programs.push_back(recent.keep(description, std::move(*program)));
  }
  return programs;
}

}  // namespace relievo::opengl
