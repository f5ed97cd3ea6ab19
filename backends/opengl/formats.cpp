#include "formats.hpp"

namespace relievo::opengl {

GlFormat gl_format(Format format) {
  switch (format) {
    case Format::r8_unorm:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE};
    case Format::rg8_unorm:
      return {GL_RG8, GL_RG, GL_UNSIGNED_BYTE};
    case Format::rgb8_unorm:
      return {GL_RGB8, GL_RGB, GL_UNSIGNED_BYTE};
    case Format::rgba8_unorm:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case Format::r16_unorm:
      return {GL_R16, GL_RED, GL_UNSIGNED_SHORT};
    case Format::rg16_unorm:
      return {GL_RG16, GL_RG, GL_UNSIGNED_SHORT};
    case Format::rgb16_unorm:
      return {GL_RGB16, GL_RGB, GL_UNSIGNED_SHORT};
    case Format::rgba16_unorm:
      return {GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT};
    case Format::r32_float:
      return {GL_R32F, GL_RED, GL_FLOAT};
    case Format::rg32_float:
      return {GL_RG32F, GL_RG, GL_FLOAT};
    case Format::rgb32_float:
      return {GL_RGB32F, GL_RGB, GL_FLOAT};
    case Format::rgba32_float:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    case Format::r32_uint:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
    case Format::d32_float:
      return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT};
    case Format::rgba16_uint:
      return {GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT};
  }
  return {};
}

GLenum min_filter(const SamplerState& state, Format format) {
  // OpenGL calls an integer texture with a linear filter incomplete and reads zeros, so these are always nearest.
  if (is_integer(format)) return GL_NEAREST_MIPMAP_NEAREST;
  if (state.min_mag == TexelFilter::nearest) {
    return state.mip == TexelFilter::nearest ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST_MIPMAP_LINEAR;
  }
  return state.mip == TexelFilter::nearest ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR;
}

GLenum mag_filter(const SamplerState& state, Format format) {
  return state.min_mag == TexelFilter::nearest || is_integer(format) ? GL_NEAREST : GL_LINEAR;
}

GLenum wrap_mode(TexelAddress address) {
  switch (address) {
    case TexelAddress::repeat:
      return GL_REPEAT;
    case TexelAddress::mirror:
      return GL_MIRRORED_REPEAT;
    case TexelAddress::clamp:
      return GL_CLAMP_TO_EDGE;
  }
  return GL_REPEAT;
}

}  // namespace relievo::opengl
