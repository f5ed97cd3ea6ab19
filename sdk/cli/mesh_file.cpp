#include "mesh_file.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <bit>
#include <cctype>
#include <map>
#include <system_error>

#include "files/whole_file.hpp"

namespace relievo::cli {

namespace {

namespace fs = std::filesystem;

Status check_file(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return file_error(path, "mesh.missing", "does not exist");
  if (fs::is_directory(status)) return file_error(path, "mesh.unreadable", "is a folder, not a file");
  if (fs::is_regular_file(status) && fs::file_size(path, code) == 0) return file_error(path, "mesh.empty", "is empty");
  return {};
}

/// Assimp's reason as the end of a sentence.
std::string reason_of(const Assimp::Importer& importer) {
  std::string reason = importer.GetErrorString();
  for (char& c : reason) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  }
  while (!reason.empty() && (reason.back() == ' ' || reason.back() == '.')) reason.pop_back();
  return reason.empty() ? "the file is not valid" : reason;
}

/// All parts of a scene as one mesh.
class Merger {
 public:
  Merger(const aiScene& scene, std::string name) : scene_(scene) {
    mesh_.name = std::move(name);
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
      has_uvs_ = has_uvs_ && scene.mMeshes[i]->HasTextureCoords(0);
      has_normals_ = has_normals_ && scene.mMeshes[i]->HasNormals();
    }
  }

  void add_node(const aiNode& node, const aiMatrix4x4& transform) {
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add_part(*scene_.mMeshes[node.mMeshes[i]], transform);
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      add_node(*node.mChildren[i], transform * node.mChildren[i]->mTransformation);
    }
  }

  Mesh take() { return std::move(mesh_); }

 private:
  using Key = std::array<std::uint32_t, 8>;

  void add_part(const aiMesh& part, const aiMatrix4x4& transform) {
    const bool mirrors = transform.Determinant() < 0;
    aiMatrix3x3 normal_transform(transform);
    normal_transform.Inverse().Transpose();
    std::vector<std::uint32_t> indices(part.mNumVertices);
    for (unsigned i = 0; i < part.mNumVertices; ++i) indices[i] = add_vertex(part, i, transform, normal_transform);
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) continue;  // points and lines
      std::array<std::uint32_t, 3> triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const unsigned index = face.mIndices[k];
        triangle[k] = index < indices.size() ? indices[index] : UINT32_MAX;  // check_mesh rejects it
      }
      if (mirrors) std::swap(triangle[1], triangle[2]);
      mesh_.triangles.push_back(triangle);
    }
  }

  std::uint32_t add_vertex(const aiMesh& part, unsigned i, const aiMatrix4x4& transform,
                           const aiMatrix3x3& normal_transform) {
    const aiVector3D position = transform * part.mVertices[i];
    aiVector3D normal;
    if (has_normals_) normal = (normal_transform * part.mNormals[i]).NormalizeSafe();
    std::array<float, 2> uv = {};
    if (has_uvs_) uv = {part.mTextureCoords[0][i].x, 1.0f - part.mTextureCoords[0][i].y};
    const std::array<float, 8> values = {position.x, position.y, position.z, normal.x,
                                         normal.y,   normal.z,   uv[0],      uv[1]};
    const auto next = static_cast<std::uint32_t>(mesh_.positions.size());
    const auto [found, is_new] = vertices_.try_emplace(std::bit_cast<Key>(values), next);
    if (is_new) {
      mesh_.positions.push_back({position.x, position.y, position.z});
      if (has_normals_) mesh_.normals.push_back({normal.x, normal.y, normal.z});
      if (has_uvs_) mesh_.uvs.push_back(uv);
    }
    return found->second;
  }

  const aiScene& scene_;
  Mesh mesh_;
  bool has_uvs_ = true, has_normals_ = true;
  std::map<Key, std::uint32_t> vertices_;
};

/// Assimp turns 3DS to Y up by its root node, which the file does not have.
aiMatrix4x4 root_transform(const aiScene& scene, const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".3ds" ? aiMatrix4x4() : scene.mRootNode->mTransformation;
}

Result<Mesh> read(const fs::path& path) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_SortByPType);
  if (scene == nullptr) {
    return file_error(path, "mesh.unreadable", fmt::format("cannot be read as a mesh: {}", reason_of(importer)));
  }
  if (scene->mRootNode == nullptr || scene->mNumMeshes == 0) {
    return file_error(path, "mesh.empty", "has no triangle; at least one is expected");
  }
  Merger merger(*scene, short_name(path));
  merger.add_node(*scene->mRootNode, root_transform(*scene, path));
  return merger.take();
}

}  // namespace

Result<Mesh> load_mesh_file(const fs::path& path) {
  if (auto file = check_file(path); !file) return tl::unexpected(file.error());
  try {
    auto mesh = read(path);
    if (!mesh) return mesh;
    if (auto report = check_mesh(*mesh, false); !report) {
      report.error().file = path.string();
      return tl::unexpected(report.error());
    }
    return mesh;
  } catch (const std::exception& exception) {
    return file_error(path, "mesh.unreadable", fmt::format("cannot be read as a mesh: {}", exception.what()));
  }
}

}  // namespace relievo::cli
