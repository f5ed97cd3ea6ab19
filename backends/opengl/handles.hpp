/// OpenGL object names that delete themselves; the context must be current.
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace relievo::opengl {

/// `Delete` is called with a name that is not 0.
template <void (*Delete)(GLuint)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint name) : name_(name) {}
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Handle() {
    if (name_ != 0) Delete(name_);
  }
  GLuint get() const { return name_; }

 private:
  GLuint name_ = 0;
};
void delete_buffer(GLuint name);
void delete_texture(GLuint name);
void delete_sampler(GLuint name);
void delete_framebuffer(GLuint name);
void delete_vertex_array(GLuint name);
void delete_query(GLuint name);
void delete_shader(GLuint name);
void delete_program(GLuint name);

using BufferHandle = Handle<delete_buffer>;
using TextureHandle = Handle<delete_texture>;
using SamplerHandle = Handle<delete_sampler>;
using FramebufferHandle = Handle<delete_framebuffer>;
using VertexArrayHandle = Handle<delete_vertex_array>;
using QueryHandle = Handle<delete_query>;
using ShaderHandle = Handle<delete_shader>;
using ProgramHandle = Handle<delete_program>;

}  // namespace relievo::opengl
