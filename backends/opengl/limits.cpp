#include "limits.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace relievo::opengl {
namespace {

std::int64_t query(GLenum name) {
  GLint64 value = 0;
  glGetInteger64v(name, &value);
  return value;
}

Status at_most(std::string what, std::int64_t given, std::int64_t allowed) {
  if (given <= allowed) return {};
  return fail(ErrorCode::unsupported, "backend.limit",
              fmt::format("{} is {}; this OpenGL driver allows at most {}", std::move(what), given, allowed));
}

Status check_texture(const Texture& texture, const Limits& limits) {
  const bool is_3d = !texture.is_array && (texture.is_3d || texture.depth > 1);
  const std::int64_t edge = std::max({texture.width, texture.height, is_3d ? texture.depth : 1});
  auto status = at_most(fmt::format("the longest edge of texture '{}'", texture.name), edge,
                        is_3d ? limits.texture_3d_size : limits.texture_size);
  if (!status) return status;
  if (texture.is_array) {
    status =
        at_most(fmt::format("the number of layers of texture '{}'", texture.name), texture.depth, limits.array_layers);
    if (!status) return status;
  }
  // glGetTextureImage counts bytes in an int.
  return at_most(fmt::format("the size in bytes of texture '{}'", texture.name),
                 static_cast<std::int64_t>(level_size(texture, 0)), std::numeric_limits<GLsizei>::max());
}

std::int64_t slot_count(ResourceKind kind, const Limits& limits) {
  switch (kind) {
    case ResourceKind::uniform_buffer:
      return limits.uniform_blocks;
    case ResourceKind::storage_buffer:
      return limits.storage_blocks;
    case ResourceKind::sampled_texture:
      return limits.texture_units;
    case ResourceKind::storage_texture:
      return limits.image_units;
  }
  return 0;
}

Status check_slots(const ShaderProgram& program, const Limits& limits) {
  for (const BindingSlot& slot : program.bindings) {
    auto status =
        at_most(fmt::format("the slot of {} '{}' of program '{}'", to_string(slot.kind), slot.name, program.name),
                slot.gl_slot, slot_count(slot.kind, limits) - 1);
    if (!status) return status;
  }
  return {};
}

Status check_bound(const Job& job, const BindingSlot& slot, int resource, const Limits& limits) {
  const auto block = [&](std::int64_t allowed) {
    const Buffer& buffer = job.buffers[resource];
    return at_most(fmt::format("the size in bytes of {} '{}'", to_string(slot.kind), buffer.name),
                   static_cast<std::int64_t>(buffer.size), allowed);
  };
  if (slot.kind == ResourceKind::uniform_buffer) return block(limits.uniform_block_size);
  if (slot.kind == ResourceKind::storage_buffer) return block(limits.storage_block_size);
  return {};
}

Status check_resources(const Job& job, int program, const std::vector<ResourceBinding>& resources,
                       const Limits& limits) {
  for (const BindingSlot& slot : job.programs[program].bindings) {
    for (const ResourceBinding& bound : resources) {
      if (bound.set != slot.set || bound.binding != slot.binding) continue;
      if (auto status = check_bound(job, slot, bound.resource, limits); !status) return status;
    }
  }
  return {};
}

Status check_dispatch(const Job& job, const Dispatch& dispatch, const Limits& limits) {
  for (int axis = 0; axis < 3; ++axis) {
    auto status = at_most(fmt::format("the number of work groups along {} of program '{}'", "xyz"[axis],
                                      job.programs[dispatch.program].name),
                          dispatch.groups[axis], limits.work_groups[axis]);
    if (!status) return status;
  }
  return check_resources(job, dispatch.program, dispatch.resources, limits);
}

Status check_draw(const Job& job, const Draw& draw, const Limits& limits) {
  // OpenGL counts both in an int.
  for (const std::int64_t count : {draw.count, draw.instances}) {
    auto status = at_most("a draw's count of vertices or instances", count, std::numeric_limits<GLsizei>::max());
    if (!status) return status;
  }
  return check_resources(job, draw.program, draw.resources, limits);
}

}  // namespace

Limits query_limits() {
  Limits limits;
  limits.texture_size = query(GL_MAX_TEXTURE_SIZE);
  limits.texture_3d_size = query(GL_MAX_3D_TEXTURE_SIZE);
  limits.array_layers = query(GL_MAX_ARRAY_TEXTURE_LAYERS);
  limits.uniform_block_size = query(GL_MAX_UNIFORM_BLOCK_SIZE);
  limits.storage_block_size = query(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  limits.uniform_blocks = query(GL_MAX_UNIFORM_BUFFER_BINDINGS);
  limits.storage_blocks = query(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
  limits.texture_units = query(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS);
  limits.image_units = query(GL_MAX_IMAGE_UNITS);
  for (GLuint axis = 0; axis < 3; ++axis) {
    glGetInteger64i_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, axis, &limits.work_groups[axis]);
  }
  glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &limits.timestamp_bits);
  return limits;
}

Status check_limits(const Job& job, const Limits& limits) {
  for (const Texture& texture : job.textures) {
    if (auto status = check_texture(texture, limits); !status) return status;
  }
  for (const ShaderProgram& program : job.programs) {
    if (auto status = check_slots(program, limits); !status) return status;
  }
  for (const Command& command : job.commands) {
    const auto* dispatch = std::get_if<Dispatch>(&command);
    auto status =
        dispatch != nullptr ? check_dispatch(job, *dispatch, limits) : check_draw(job, std::get<Draw>(command), limits);
    if (!status) return status;
  }
  return {};
}

}  // namespace relievo::opengl
