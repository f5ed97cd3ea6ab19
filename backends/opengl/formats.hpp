/// The Job's formats and sampler state in OpenGL's words.
#pragma once

#include <epoxy/gl.h>

#include "relievo/job.hpp"

namespace relievo::opengl {

/// `external` and `type` describe the Job's tightly packed bytes; `internal` is the texture's own format.
struct GlFormat {
  GLenum internal = 0, external = 0, type = 0;
};

GlFormat gl_format(Format format);
GLenum min_filter(const SamplerState& state, Format format);
GLenum mag_filter(const SamplerState& state, Format format);
GLenum wrap_mode(TexelAddress address);

}  // namespace relievo::opengl
