#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "files/whole_file.hpp"
#include "relievo/scene.hpp"
#include "scene/scene_section.hpp"
#include "scene/vectors.hpp"

namespace relievo {

namespace {

constexpr std::array<std::string_view, 5> mesh_kinds = {"plane", "sphere", "cylinder", "torus", "file"};
constexpr std::array<std::string_view, 2> uv_sources = {"file", "spherical"};
constexpr std::array<std::string_view, 2> displacement_units = {"world", "frame"};
constexpr std::array<std::string_view, 4> address_modes = {"repeat", "mirror", "clamp", "clip"};
constexpr int max_slices = 4096;
constexpr int max_scene_extent = 8192;

void allow_mesh_keys(SceneSection& section, MeshKind kind) {
  switch (kind) {
    case MeshKind::plane:
      return section.allow_keys({"kind", "uv", "uv_scale", "size"});
    case MeshKind::sphere:
      return section.allow_keys({"kind", "uv", "uv_scale", "radius", "slices", "stacks"});
    case MeshKind::cylinder:
      return section.allow_keys({"kind", "uv", "uv_scale", "radius", "height", "slices"});
    case MeshKind::torus:
      return section.allow_keys({"kind", "uv", "uv_scale", "radius", "minor_radius", "slices", "stacks"});
    case MeshKind::file:
      return section.allow_keys({"kind", "uv", "uv_scale", "path"});
  }
}

/// Reads one scene; the first error of the file is in errors_.
class SceneReader {
 public:
  SceneReader(const TomlValue& root, const std::filesystem::path& file) : root_(root), folder_(file.parent_path()) {
    errors_.file = file.string();
    scene_.file = file.string();
  }

  Result<Scene> read() {
    SceneSection(root_, "scene", errors_)
        .allow_keys({"mesh", "height_map", "displacement", "camera", "light", "material", "image"});
    read_mesh();
    read_height_map();
    read_displacement();
    read_camera();
    read_lights();
    read_material();
    read_image();
    if (errors_.error) return tl::unexpected(std::move(*errors_.error));
    return std::move(scene_);
  }

 private:
  /// The table at `key`, or null when it is absent.
  const TomlValue* find_table(std::string_view key) {
    const TomlEntry* entry = find_entry(root_, key);
    if (entry == nullptr) return nullptr;
    if (entry->value.kind == TomlValue::Kind::table) return &entry->value;
    TomlReader(root_, "scene", errors_)
        .report("scene.type",
                fmt::format("{} of the scene is {}; a table is expected", quote(key), describe_value(entry->value)),
                key);
    return nullptr;
  }

  void read_mesh() {
    const TomlValue* table = find_table("mesh");
    if (table == nullptr) return;
    SceneMesh& mesh = scene_.mesh;
    SceneSection(*table, "mesh", errors_).choice("kind", mesh_kinds, mesh.kind);
    SceneSection section(*table, fmt::format("mesh of kind {}", quote(to_string(mesh.kind))), errors_);
    allow_mesh_keys(section, mesh.kind);
    if (mesh.kind == MeshKind::file) section.path("path", folder_, mesh.path);
    section.choice("uv", uv_sources, mesh.uv);
    section.pair("uv_scale", mesh.uv_scale);
    if (mesh.uv_scale[0] == 0 || mesh.uv_scale[1] == 0) {
      section.report("\"uv_scale\" of the mesh has a 0; two numbers other than 0 are expected", "uv_scale");
    }
    section.number("size", mesh.size, ranges::positive);
    section.number("radius", mesh.radius, ranges::positive);
    section.number("minor_radius", mesh.minor_radius, ranges::positive);
    section.number("height", mesh.height, ranges::positive);
    section.integer("slices", mesh.slices, 3, max_slices);
    section.integer("stacks", mesh.stacks, mesh.kind == MeshKind::torus ? 3 : 2, max_slices);
  }

  void read_height_map() {
    const TomlValue* table = find_table("height_map");
    if (table == nullptr) return;
    SceneSection section(*table, "height map", errors_);
    section.allow_keys({"path", "address"});
    section.path("path", folder_, scene_.height_map.path);
    section.choice("address", address_modes, scene_.height_map.address);
  }

  void read_displacement() {
    const TomlValue* table = find_table("displacement");
    if (table == nullptr) return;
    SceneSection section(*table, "displacement", errors_);
    section.allow_keys({"scale", "bias", "units"});
    section.number("scale", scene_.displacement.scale);
    section.number("bias", scene_.displacement.bias);
    section.choice("units", displacement_units, scene_.displacement.units);
  }

  void read_camera() {
    const TomlValue* table = find_table("camera");
    if (table == nullptr) return;
    SceneCamera& camera = scene_.camera;
    SceneSection section(*table, "camera", errors_);
    section.allow_keys({"position", "target", "up", "vertical_fov", "near", "far"});
    section.vector("position", camera.position);
    section.vector("target", camera.target);
    section.vector("up", camera.up);
    section.number("vertical_fov", camera.vertical_fov, ranges::angle);
    section.number("near", camera.near_plane, ranges::positive);
    section.number("far", camera.far_plane, ranges::positive);
    check_camera(section, camera);
  }

  static void check_camera(SceneSection& section, const SceneCamera& camera) {
    if (camera.near_plane >= camera.far_plane) {
      section.report(fmt::format("\"near\" of the camera is {} and \"far\" is {}; near below far is expected",
                                 camera.near_plane, camera.far_plane),
                     section.has("near") ? "near" : "far");
    }
    const glm::dvec3 forward = to_double(camera.target) - to_double(camera.position), up = to_double(camera.up);
    const double distance = glm::length(forward), length = glm::length(up);
    if (!(distance > 0)) {
      section.report("the camera's target is its position; a target apart from it is expected", "target");
    } else if (!(length > 0)) {
      section.report("\"up\" of the camera is 0; a direction is expected", "up");
    } else if (glm::length(glm::cross(forward / distance, up / length)) < 1e-6) {
      section.report("\"up\" of the camera is parallel to its view direction; another direction is expected", "up");
    }
  }

  void read_lights() {
    const TomlEntry* entry = find_entry(root_, "light");
    if (entry == nullptr) return;
    TomlReader root(root_, "scene", errors_);
    root.table_list("light");  // reports what is no array of tables
    scene_.lights.clear();
    for (const TomlValue& table : entry->value.items) {
      if (table.kind == TomlValue::Kind::table) read_light(table);
    }
  }

  void read_light(const TomlValue& table) {
    SceneLight light;
    SceneSection section(table, fmt::format("light {}", scene_.lights.size() + 1), errors_);
    section.allow_keys({"direction", "color"});
    section.vector("direction", light.direction);
    section.vector("color", light.color, ranges::not_negative);
    if (!(glm::length(to_double(light.direction)) > 0)) {
      section.report("\"direction\" of the light is 0; a direction towards the light is expected", "direction");
    }
    scene_.lights.push_back(light);
  }

  void read_material() {
    const TomlValue* table = find_table("material");
    if (table == nullptr) return;
    SceneSection section(*table, "material", errors_);
    section.allow_keys({"albedo", "ambient", "specular", "shininess"});
    section.vector("albedo", scene_.material.albedo, ranges::unit);
    section.number("ambient", scene_.material.ambient, ranges::not_negative);
    section.number("specular", scene_.material.specular, ranges::not_negative);
    section.number("shininess", scene_.material.shininess, ranges::positive);
  }

  void read_image() {
    const TomlValue* table = find_table("image");
    if (table == nullptr) return;
    SceneSection section(*table, "image", errors_);
    section.allow_keys({"width", "height"});
    section.integer("width", scene_.image.width, 1, max_scene_extent);
    section.integer("height", scene_.image.height, 1, max_scene_extent);
  }

  const TomlValue& root_;
  std::filesystem::path folder_;
  FirstError errors_;
  Scene scene_;
};

/// The reader is shared with descriptors; a scene's errors carry its own name.
Error as_scene_error(Error error) {
  constexpr std::string_view prefix = "describe.";
  if (error.id.starts_with(prefix)) error.id.replace(0, prefix.size(), "scene.");
  return error;
}

}  // namespace

std::string_view to_string(MeshKind kind) {
  return mesh_kinds[static_cast<std::size_t>(kind)];
}
std::string_view to_string(UvSource source) {
  return uv_sources[static_cast<std::size_t>(source)];
}
std::string_view to_string(DisplacementUnits units) {
  return displacement_units[static_cast<std::size_t>(units)];
}

Result<Scene> parse_scene(std::string_view text, const std::filesystem::path& file) {
  const auto root = parse_toml(text, file.string());
  if (!root) return tl::unexpected(as_scene_error(root.error()));
  return SceneReader(*root, file).read().map_error(as_scene_error);
}

Result<Scene> load_scene(const std::filesystem::path& path) {
  const auto bytes = read_file(path, "scene");
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_scene({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path);
}

}  // namespace relievo
