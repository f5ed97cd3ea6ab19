/// What a picture is made of: a mesh, its height map, camera, lights and material. The file format is in
/// docs/scenes.md.
/// Every function here is thread-safe.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/height_map.hpp"
#include "relievo/mesh.hpp"
#include "relievo/result.hpp"

namespace relievo {

enum class MeshKind { plane, sphere, cylinder, torus, file };
std::string_view to_string(MeshKind kind);

/// Where texture coordinates come from: the mesh, or `project_spherical_uvs`.
enum class UvSource { file, spherical };
std::string_view to_string(UvSource source);

/// What displacement.scale and bias are relative to: world units along the unit normal, or the length of the
/// texture frame (survey Eq. 6).
enum class DisplacementUnits { world, frame };
std::string_view to_string(DisplacementUnits units);

struct SceneMesh {
  MeshKind kind = MeshKind::plane;
  std::filesystem::path path;  ///< kind file: resolved against the scene's folder
  UvSource uv = UvSource::file;
  std::array<float, 2> uv_scale = {1, 1};  ///< multiplies the texture coordinates; neither is 0
  float size = 2;                          ///< plane: edge length, world units
  float radius = 1;                        ///< sphere, cylinder; torus: of the ring; world units
  float minor_radius = 0.4f;               ///< torus: of the tube
  float height = 2;                        ///< cylinder
  int slices = 32, stacks = 16;            ///< sphere, cylinder (slices), torus
};

struct SceneHeightMap {
  std::filesystem::path path;  ///< resolved against the scene's folder; empty = a flat map
  AddressMode address = AddressMode::repeat;
};

/// The displacement is bias + scale·t along the normal.
struct SceneDisplacement {
  float scale = 0.1f;  ///< finite; may be 0 or negative
  float bias = 0;
  DisplacementUnits units = DisplacementUnits::world;
};

/// A perspective camera, right-handed, world units.
struct SceneCamera {
  std::array<float, 3> position = {0, -2, 2}, target = {0, 0, 0}, up = {0, 0, 1};
  float vertical_fov = 45;  ///< degrees, in (0,180)
  float near_plane = 0.1f, far_plane = 100;
};

struct SceneLight {
  std::array<float, 3> direction = {0.4f, -0.3f, 0.85f};  ///< towards the light; any length above 0
  std::array<float, 3> color = {1, 1, 1};                 ///< linear
};

struct SceneMaterial {
  std::array<float, 3> albedo = {0.7f, 0.7f, 0.7f};  ///< linear
  float ambient = 0.1f;
  float specular = 0;
  float shininess = 32;
};

struct SceneImage {
  int width = 640, height = 480;  ///< pixels, 1–8192
};

struct Scene {
  std::string file;  ///< where it was read, for messages
  SceneMesh mesh;
  SceneHeightMap height_map;
  SceneDisplacement displacement;
  SceneCamera camera;
  std::vector<SceneLight> lights = {SceneLight{}};
  SceneMaterial material;
  SceneImage image;
};

/// Reads and validates a scene. Errors ("scene.*") have line and column, the given value, what was expected, and for an
/// unknown key the nearest one. Files that it names are not opened.
Result<Scene> load_scene(const std::filesystem::path& path);

/// As above from text; `file` is used in messages, and relative paths resolve against its folder.
Result<Scene> parse_scene(std::string_view text, const std::filesystem::path& file);

/// Reads a mesh file, with or without texture coordinates and normals.
using MeshLoader = std::function<Result<Mesh>(const std::filesystem::path& path)>;

/// The scene's mesh, checked, with its uv source and uv_scale applied and one normal a position. The library reads no
/// mesh files: kind `file` needs a `loader`, else the error is "scene.mesh-loader".
Result<Mesh> scene_mesh(const Scene& scene, const MeshLoader& loader = {});

/// The scene's height map with its address mode; a flat one (a single texel, 0) when none is named.
Result<HeightMap> scene_height_map(const Scene& scene);

}  // namespace relievo
