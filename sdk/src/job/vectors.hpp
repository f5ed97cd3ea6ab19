/// The scene's vectors as glm's.
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace relievo {

inline glm::vec3 to_vec3(const std::array<float, 3>& a) {
  return {a[0], a[1], a[2]};
}

}  // namespace relievo
