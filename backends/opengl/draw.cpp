#include "draw.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "formats.hpp"

namespace relievo::opengl {
namespace {

Result<FramebufferHandle> make_framebuffer(const Resources& resources, const Draw& draw) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  FramebufferHandle framebuffer(name);
  std::vector<GLenum> buffers;
  for (const int target : draw.color_targets) {
    buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(buffers.size()));
    glNamedFramebufferTexture(name, buffers.back(), resources.textures[target].handle.get(), 0);
  }
  if (draw.depth_target >= 0) {
    glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, resources.textures[draw.depth_target].handle.get(), 0);
  }
  glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(buffers.size()), buffers.data());
  const GLenum status = glCheckNamedFramebufferStatus(name, GL_DRAW_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return framebuffer;
  return fail(ErrorCode::unsupported, "backend.framebuffer",
              fmt::format("the OpenGL driver does not draw to these targets together: status 0x{:x}, expected "
                          "GL_FRAMEBUFFER_COMPLETE",
                          status));
}

/// The nearest value that an unsigned integer has.
GLuint to_uint(float value) {
  constexpr float first_too_large = 4294967296.0f;
  if (value <= 0) return 0;
  return value < first_too_large ? static_cast<GLuint>(value) : ~GLuint{0};
}

void clear_targets(const Job& job, GLuint framebuffer, const Draw& draw) {
  for (int i = 0; draw.clear_color && i < static_cast<int>(draw.color_targets.size()); ++i) {
    const auto& color = *draw.clear_color;
    if (is_integer(job.textures[draw.color_targets[i]].format)) {
      const GLuint value[4] = {to_uint(color[0]), to_uint(color[1]), to_uint(color[2]), to_uint(color[3])};
      glClearNamedFramebufferuiv(framebuffer, GL_COLOR, i, value);
    } else {
      glClearNamedFramebufferfv(framebuffer, GL_COLOR, i, color.data());
    }
  }
  if (draw.clear_depth && draw.depth_target >= 0) {
    glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &*draw.clear_depth);
  }
}

VertexArrayHandle make_vertex_array(const Resources& resources, const Draw& draw) {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  for (const VertexAttribute& attribute : draw.attributes) {
    const auto location = static_cast<GLuint>(attribute.location);
    const auto offset = static_cast<GLuint>(attribute.offset);
    const GLenum type = gl_format(attribute.format).type;
    glEnableVertexArrayAttrib(name, location);
    glVertexArrayAttribBinding(name, location, 0);
    if (is_integer(attribute.format)) {
      glVertexArrayAttribIFormat(name, location, channel_count(attribute.format), type, offset);
    } else {
      glVertexArrayAttribFormat(name, location, channel_count(attribute.format), type, GL_FALSE, offset);
    }
  }
  if (!draw.attributes.empty()) {
    glVertexArrayVertexBuffer(name, 0, resources.buffers[draw.vertex_buffer].get(), 0, draw.vertex_stride);
  }
  if (draw.index_buffer >= 0) glVertexArrayElementBuffer(name, resources.buffers[draw.index_buffer].get());
  return VertexArrayHandle(name);
}

void set_enabled(GLenum what, bool enabled) {
  enabled ? glEnable(what) : glDisable(what);
}

/// The Job's clip space is Vulkan's: depth in [0,1], and NDC y = −1 lands on row 0 of the target's memory, which is
/// what GL_LOWER_LEFT does when nobody flips images later.
void set_clip_space(const Texture& target) {
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthRange(0.0, 1.0);
  glViewport(0, 0, target.width, target.height);
  // Flat inputs come from a triangle's first vertex in Vulkan, from its last in OpenGL.
  glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
}

void set_raster_state(const Draw& draw) {
  // OpenGL judges the winding with y upwards; our images have row 0 at the top, so counter-clockwise is its GL_CW.
  glFrontFace(GL_CW);
  set_enabled(GL_CULL_FACE, draw.cull != CullMode::none);
  glCullFace(draw.cull == CullMode::front ? GL_FRONT : GL_BACK);
  set_enabled(GL_DEPTH_TEST, draw.depth_target >= 0);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  for (const GLenum what : {GL_FRAMEBUFFER_SRGB, GL_DITHER, GL_BLEND, GL_SCISSOR_TEST, GL_STENCIL_TEST})
    glDisable(what);
}

void draw_primitives(const Program& program, const Draw& draw) {
  const GLenum mode = program.tessellated ? GL_PATCHES : GL_TRIANGLES;
  if (program.tessellated) glPatchParameteri(GL_PATCH_VERTICES, 3);
  const auto count = static_cast<GLsizei>(draw.count);
  const auto instances = static_cast<GLsizei>(draw.instances);
  if (draw.index_buffer >= 0) {
    glDrawElementsInstanced(mode, count, GL_UNSIGNED_INT, nullptr, instances);
  } else {
    glDrawArraysInstanced(mode, 0, count, instances);
  }
}

}  // namespace

Status run_draw(const Job& job, const Resources& resources, const Program& program, const Draw& draw) {
  const auto framebuffer = make_framebuffer(resources, draw);
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  const VertexArrayHandle vertex_array = make_vertex_array(resources, draw);
  const int target = draw.color_targets.empty() ? draw.depth_target : draw.color_targets.front();
  set_clip_space(job.textures[target]);
  set_raster_state(draw);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer->get());
  glBindVertexArray(vertex_array.get());
  clear_targets(job, framebuffer->get(), draw);
  draw_primitives(program, draw);
  return {};
}

}  // namespace relievo::opengl
