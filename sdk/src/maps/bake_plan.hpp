/// How a map is dealt out: its layers to Jobs, and what one Job writes to storage buffers.
#pragma once

#include <cstddef>

#include "relievo/maps.hpp"

namespace relievo {

struct BakePlan {
  int layers = 1;                 ///< that one Job bakes; the last Job may have fewer
  std::size_t layer_floats = 0;   ///< of one layer, all levels
  std::size_t buffer_floats = 0;  ///< of every storage buffer of a Job but the last

  /// Buffers that so many layers take, and the floats of one of them.
  std::size_t buffers(int layer_count) const;
  std::size_t in_buffer(std::size_t buffer, int layer_count) const;
};

/// Layers that read one another stay together. Of others as many as fit in a storage buffer of the backend, and in four
/// times the height map (or 8 MiB): a Job's texels are there three times while they are read back. Layers that one run
/// writes stay together where they fit.
/// Errors: "maps.too-large" when what stays together does not fit in most_bake_buffers.
Result<BakePlan> plan_bake(const MapData& output, const MapDescriptor& descriptor, const MapData& height,
                           const BackendInfo& backend);

}  // namespace relievo
