/// The Job's buffers and textures on the GPU.
#pragma once

#include <cstddef>
#include <vector>

#include "handles.hpp"
#include "relievo/job.hpp"

namespace relievo::opengl {

struct GpuTexture {
  TextureHandle handle;
  SamplerHandle sampler;
};

struct Resources {
  std::vector<BufferHandle> buffers;
  std::vector<GpuTexture> textures;
};

/// Makes and fills everything; what the job leaves undefined is zero. Sets the pixel store alignment to 1 byte.
Resources upload_resources(const Job& job);

/// Puts a resource into the slot of the current context; `resource` indexes the job's buffers or textures by kind.
void bind_resource(const Job& job, const Resources& resources, const BindingSlot& slot, int resource);

std::vector<std::byte> read_back(const Job& job, const Resources& resources, const ReadBack& what);

}  // namespace relievo::opengl
