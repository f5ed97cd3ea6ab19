#include "job/camera.hpp"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "job/vectors.hpp"

namespace relievo {

glm::mat4 view_projection(const Scene& scene) {
  const SceneCamera& camera = scene.camera;
  float aspect = static_cast<float>(scene.image.width) / static_cast<float>(scene.image.height);
  glm::mat4 projection =
      glm::perspectiveRH_ZO(glm::radians(camera.vertical_fov), aspect, camera.near_plane, camera.far_plane);
  projection[1][1] = -projection[1][1];
  return projection * glm::lookAtRH(to_vec3(camera.position), to_vec3(camera.target), to_vec3(camera.up));
}

}  // namespace relievo
