#include "resources.hpp"

#include <algorithm>

#include "formats.hpp"

namespace relievo::opengl {
namespace {

// A uniform block ends on a multiple of a vec4, its buffer in the job perhaps before.
std::size_t padded_size(const Buffer& buffer) {
  return (buffer.size + 15) / 16 * 16;
}

/// With three coordinates: a 3D texture, or an array.
bool is_deep(const Texture& texture) {
  return texture.is_array || texture.is_3d || texture.depth > 1;
}

GLenum target_of(const Texture& texture) {
  if (texture.is_array) return GL_TEXTURE_2D_ARRAY;
  return is_deep(texture) ? GL_TEXTURE_3D : GL_TEXTURE_2D;
}

int level_extent(int extent, int level) {
  return std::max(1, extent >> level);
}

BufferHandle upload_buffer(const Buffer& buffer) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  BufferHandle handle(name);
  const auto size = static_cast<GLsizeiptr>(padded_size(buffer));
  if (buffer.data.empty()) {
    glNamedBufferStorage(name, size, nullptr, 0);
    glClearNamedBufferData(name, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    return handle;
  }
  std::vector<std::byte> bytes = buffer.data;
  bytes.resize(padded_size(buffer));
  glNamedBufferStorage(name, size, bytes.data(), 0);
  return handle;
}

void upload_level(GLuint name, const Texture& texture, int level) {
  const GlFormat format = gl_format(texture.format);
  if (texture.data.empty()) {
    glClearTexImage(name, level, format.external, format.type, nullptr);
    return;
  }
  const int width = level_extent(texture.width, level), height = level_extent(texture.height, level);
  const std::byte* bytes = texture.data[level].data();
  if (is_deep(texture)) {
    glTextureSubImage3D(name, level, 0, 0, 0, width, height, level_extent(texture.depth, level), format.external,
                        format.type, bytes);
  } else {
    glTextureSubImage2D(name, level, 0, 0, width, height, format.external, format.type, bytes);
  }
}

TextureHandle upload_texture(const Texture& texture) {
  const GLenum internal = gl_format(texture.format).internal;
  GLuint name = 0;
  glCreateTextures(target_of(texture), 1, &name);
  if (is_deep(texture)) {
    glTextureStorage3D(name, texture.levels, internal, texture.width, texture.height, texture.depth);
  } else {
    glTextureStorage2D(name, texture.levels, internal, texture.width, texture.height);
  }
  for (int level = 0; level < texture.levels; ++level) upload_level(name, texture, level);
  return TextureHandle(name);
}

SamplerHandle make_sampler(const Texture& texture) {
  const SamplerState& state = texture.sampler;
  GLuint name = 0;
  glCreateSamplers(1, &name);
  const auto set = [name](GLenum what, GLenum value) { glSamplerParameteri(name, what, static_cast<GLint>(value)); };
  set(GL_TEXTURE_MIN_FILTER, min_filter(state, texture.format));
  set(GL_TEXTURE_MAG_FILTER, mag_filter(state, texture.format));
  set(GL_TEXTURE_WRAP_S, wrap_mode(state.address[0]));
  set(GL_TEXTURE_WRAP_T, wrap_mode(state.address[1]));
  set(GL_TEXTURE_WRAP_R, wrap_mode(state.address[2]));
  return SamplerHandle(name);
}

}  // namespace

Resources upload_resources(const Job& job) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  Resources resources;
  for (const Buffer& buffer : job.buffers) resources.buffers.push_back(upload_buffer(buffer));
  for (const Texture& texture : job.textures) {
    resources.textures.push_back({upload_texture(texture), make_sampler(texture)});
  }
  return resources;
}

void bind_resource(const Job& job, const Resources& resources, const BindingSlot& slot, int resource) {
  const auto unit = static_cast<GLuint>(slot.gl_slot);
  switch (slot.kind) {
    case ResourceKind::uniform_buffer:
      glBindBufferBase(GL_UNIFORM_BUFFER, unit, resources.buffers[resource].get());
      return;
    case ResourceKind::storage_buffer:
      // The exact size, so that .length() of an unsized array is right.
      glBindBufferRange(GL_SHADER_STORAGE_BUFFER, unit, resources.buffers[resource].get(), 0,
                        static_cast<GLsizeiptr>(job.buffers[resource].size));
      return;
    case ResourceKind::sampled_texture:
      glBindTextureUnit(unit, resources.textures[resource].handle.get());
      glBindSampler(unit, resources.textures[resource].sampler.get());
      return;
    case ResourceKind::storage_texture:
      glBindImageTexture(unit, resources.textures[resource].handle.get(), 0, GL_TRUE, 0, GL_READ_WRITE,
                         gl_format(job.textures[resource].format).internal);
      return;
  }
}

std::vector<std::byte> read_back(const Job& job, const Resources& resources, const ReadBack& what) {
  if (what.source == ReadBack::Source::buffer) {
    std::vector<std::byte> bytes(job.buffers[what.index].size);
    glGetNamedBufferSubData(resources.buffers[what.index].get(), 0, static_cast<GLsizeiptr>(bytes.size()),
                            bytes.data());
    return bytes;
  }
  const Texture& texture = job.textures[what.index];
  const GlFormat format = gl_format(texture.format);
  std::vector<std::byte> bytes(level_size(texture, what.level));
  glGetTextureImage(resources.textures[what.index].handle.get(), what.level, format.external, format.type,
                    static_cast<GLsizei>(bytes.size()), bytes.data());
  return bytes;
}

}  // namespace relievo::opengl
