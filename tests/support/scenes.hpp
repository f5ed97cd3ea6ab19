/// Small scenes for tests of pictures.
#pragma once

#include <string>

#include "relievo/render.hpp"
#include "relievo/scene.hpp"

namespace relievo::test {

/// A closed mesh or a plane in the middle of a small picture, seen from obliquely above.
inline Scene make_scene(MeshKind kind, int size = 160, float scale = 0.12f) {
  Scene scene;
  scene.mesh.kind = kind;
  scene.mesh.slices = kind == MeshKind::torus ? 24 : 16;
  scene.mesh.stacks = kind == MeshKind::torus ? 12 : 8;
  scene.displacement.scale = scale;
  scene.camera.position = {0.6f, -2.9f, 2.1f};
  scene.image = {size, size};
  scene.material.specular = 0.2f;
  return scene;
}

/// The scene's own mesh: generated, checked, one normal a position.
inline Mesh mesh_of(const Scene& scene) {
  Result<Mesh> mesh = scene_mesh(scene);
  return mesh ? std::move(*mesh) : Mesh{};
}

/// Of a picture with the exact filter.
inline RenderRequest request_of(const std::string& stage, const std::string& technique, Aov aov = Aov::color) {
  RenderRequest request;
  request.stage = stage;
  request.technique = technique;
  request.filter = HeightFilter::exact;
  request.aov = aov;
  return request;
}

}  // namespace relievo::test
