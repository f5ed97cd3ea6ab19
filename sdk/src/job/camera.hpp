/// The scene's camera as a matrix.
#pragma once

#include <glm/mat4x4.hpp>

#include "relievo/scene.hpp"

namespace relievo {

/// World → Vulkan's clip space: y down, depth in [0,1].
glm::mat4 view_projection(const Scene& scene);

}  // namespace relievo
