#include <fmt/format.h>

#include "files/whole_file.hpp"
#include "relievo/scene.hpp"

namespace relievo {

namespace {

Result<Mesh> make_mesh(const SceneMesh& mesh, const MeshLoader& loader) {
  switch (mesh.kind) {
    case MeshKind::plane:
      return make_plane(mesh.size);
    case MeshKind::sphere:
      return make_sphere(mesh.radius, mesh.slices, mesh.stacks);
    case MeshKind::cylinder:
      return make_cylinder(mesh.radius, mesh.height, mesh.slices);
    case MeshKind::torus:
      return make_torus(mesh.radius, mesh.minor_radius, mesh.slices, mesh.stacks);
    default:
      break;
  }
  if (loader) return loader(mesh.path);
  return fail(
      ErrorCode::usage, "scene.mesh-loader",
      fmt::format("the scene's mesh is the file '{}', which the library does not read; a mesh loader is expected",
                  short_name(mesh.path)),
      mesh.path.string());
}

tl::unexpected<Error> in_file(Error error, const SceneMesh& mesh) {
  if (error.file.empty()) error.file = mesh.path.string();
  return tl::unexpected(std::move(error));
}

}  // namespace

Result<Mesh> scene_mesh(const Scene& scene, const MeshLoader& loader) {
  auto mesh = make_mesh(scene.mesh, loader);
  if (!mesh) return in_file(mesh.error(), scene.mesh);
  const bool projects = scene.mesh.uv == UvSource::spherical;
  if (auto report = check_mesh(*mesh, !projects); !report) return in_file(report.error(), scene.mesh);
  if (projects) project_spherical_uvs(*mesh);
  scale_uvs(*mesh, scene.mesh.uv_scale);
  weld_normals(*mesh);
  // Scaling and projecting may leave the floats.
  if (auto report = check_mesh(*mesh); !report) return in_file(report.error(), scene.mesh);
  return mesh;
}

Result<HeightMap> scene_height_map(const Scene& scene) {
  HeightMap map{1, 1, {0.0f}, scene.height_map.address};
  if (!scene.height_map.path.empty()) {
    auto loaded = load_height_map(scene.height_map.path);
    if (!loaded) return loaded;
    map = std::move(*loaded);
  }
  map.address = scene.height_map.address;
  return map;
}

}  // namespace relievo
