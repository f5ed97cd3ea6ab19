/// Mesh files through Assimp: the library itself reads none.
#pragma once

#include <filesystem>

#include "relievo/mesh.hpp"
#include "relievo/result.hpp"

namespace relievo::cli {

/// Reads every triangle of a file (3DS, OBJ, PLY, glTF, …) as one mesh in the file's own axes, vertices joined where
/// all attributes are bit-equal. The texture coordinate v is turned over, since row 0 of a height map is v = 0 and
/// files count from the bottom. Normals or texture coordinates that a part of the file lacks are left out altogether.
/// What comes back passes `check_mesh` but may lack texture coordinates. Fits `MeshLoader`. Errors: "mesh.*".
Result<Mesh> load_mesh_file(const std::filesystem::path& path);

}  // namespace relievo::cli
