/// What the driver can hold, checked before the job starts, so that the error says more than GL_INVALID_VALUE.
#pragma once

#include <array>
#include <cstdint>

#include "relievo/job.hpp"
#include "relievo/result.hpp"

namespace relievo::opengl {

struct Limits {
  std::int64_t texture_size = 0, texture_3d_size = 0;  ///< texels along an edge
  std::int64_t array_layers = 0;
  std::int64_t uniform_block_size = 0, storage_block_size = 0;  ///< bytes
  std::int64_t uniform_blocks = 0, storage_blocks = 0, texture_units = 0, image_units = 0;
  std::array<std::int64_t, 3> work_groups = {0, 0, 0};
  int timestamp_bits = 0;  ///< 0: the driver has no GPU clock
};

/// Asks the current context.
Limits query_limits();

/// Error: "backend.limit", ErrorCode::unsupported, with the given and the allowed value. The job is valid, so what
/// every OpenGL 4.5 driver holds is checked already.
Status check_limits(const Job& job, const Limits& limits);

}  // namespace relievo::opengl
