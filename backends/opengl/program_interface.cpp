#include "program_interface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

namespace relievo::opengl {
namespace {

GLenum block_interface(ResourceKind kind) {
  return kind == ResourceKind::uniform_buffer ? GL_UNIFORM_BLOCK : GL_SHADER_STORAGE_BLOCK;
}

/// The kind of an opaque uniform's type; nothing for plain numbers.
std::optional<ResourceKind> texture_kind(GLint type) {
  switch (type) {
    case GL_SAMPLER_2D:
    case GL_SAMPLER_2D_ARRAY:
    case GL_SAMPLER_3D:
    case GL_SAMPLER_2D_SHADOW:
    case GL_INT_SAMPLER_2D:
    case GL_INT_SAMPLER_2D_ARRAY:
    case GL_INT_SAMPLER_3D:
    case GL_UNSIGNED_INT_SAMPLER_2D:
    case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
    case GL_UNSIGNED_INT_SAMPLER_3D:
      return ResourceKind::sampled_texture;
    case GL_IMAGE_2D:
    case GL_IMAGE_2D_ARRAY:
    case GL_IMAGE_3D:
    case GL_INT_IMAGE_2D:
    case GL_INT_IMAGE_2D_ARRAY:
    case GL_INT_IMAGE_3D:
    case GL_UNSIGNED_INT_IMAGE_2D:
    case GL_UNSIGNED_INT_IMAGE_2D_ARRAY:
    case GL_UNSIGNED_INT_IMAGE_3D:
      return ResourceKind::storage_texture;
    default:
      return std::nullopt;
  }
}

GLint active_count(GLuint name, GLenum interface) {
  GLint count = 0;
  glGetProgramInterfaceiv(name, interface, GL_ACTIVE_RESOURCES, &count);
  return count;
}

GLint property(GLuint name, GLenum interface, GLuint index, GLenum what) {
  GLint value = -1;
  glGetProgramResourceiv(name, interface, index, 1, &what, 1, nullptr, &value);
  return value;
}

Status check_slot(const ShaderProgram& program, GLuint name, GLenum interface, GLuint index, ResourceKind kind,
                  GLint slot) {
  const bool known = std::any_of(program.bindings.begin(), program.bindings.end(), [&](const BindingSlot& binding) {
    return binding.kind == kind && binding.gl_slot == slot;
  });
  if (known) return {};
  std::array<GLchar, 256> label{};
  glGetProgramResourceName(name, interface, index, label.size(), nullptr, label.data());
  return fail(ErrorCode::usage, "backend.binding-contract",
              fmt::format("program '{}' uses {} '{}' in slot {}, which its bindings do not list", program.name,
                          to_string(kind), label.data(), slot));
}

Status check_blocks(const ShaderProgram& program, GLuint name, ResourceKind kind) {
  const GLenum interface = block_interface(kind);
  for (GLint i = 0; i < active_count(name, interface); ++i) {
    const GLint slot = property(name, interface, i, GL_BUFFER_BINDING);
    if (auto status = check_slot(program, name, interface, i, kind, slot); !status) return status;
  }
  return {};
}

Status check_textures(const ShaderProgram& program, GLuint name) {
  for (GLint i = 0; i < active_count(name, GL_UNIFORM); ++i) {
    const auto kind = texture_kind(property(name, GL_UNIFORM, i, GL_TYPE));
    if (!kind) continue;
    GLint slot = -1;
    glGetUniformiv(name, property(name, GL_UNIFORM, i, GL_LOCATION), &slot);
    if (auto status = check_slot(program, name, GL_UNIFORM, i, *kind, slot); !status) return status;
  }
  return {};
}

void assign_slot(const BindingSlot& binding, GLuint name) {
  const auto slot = static_cast<GLuint>(binding.gl_slot);
  if (binding.kind == ResourceKind::sampled_texture || binding.kind == ResourceKind::storage_texture) {
    const GLint location = glGetUniformLocation(name, binding.name.c_str());
    if (location >= 0) glProgramUniform1i(name, location, binding.gl_slot);
    return;
  }
  const GLuint index = glGetProgramResourceIndex(name, block_interface(binding.kind), binding.name.c_str());
  if (index == GL_INVALID_INDEX) return;
  if (binding.kind == ResourceKind::uniform_buffer) {
    glUniformBlockBinding(name, index, slot);
  } else {
    glShaderStorageBlockBinding(name, index, slot);
  }
}

}  // namespace

void assign_slots(const ShaderProgram& program, GLuint name) {
  for (const BindingSlot& binding : program.bindings) assign_slot(binding, name);
}

Status check_contract(const ShaderProgram& program, GLuint name) {
  if (auto status = check_blocks(program, name, ResourceKind::uniform_buffer); !status) return status;
  if (auto status = check_blocks(program, name, ResourceKind::storage_buffer); !status) return status;
  return check_textures(program, name);
}

}  // namespace relievo::opengl
