/// Reads a user's folder of techniques, maps and stages into the source tree.
#pragma once

#include <filesystem>

#include "relievo/describe.hpp"

namespace relievo {

/// Adds the .glsl and .toml files of every subfolder of `folder` (or of `folder` itself) that holds a descriptor, below
/// "techniques/<name>/", "shaders/maps/<name>/" or "shaders/stages/<name>/", and notes where they lie in `origins`.
/// Hidden files, and links that lead out of `folder`, are passed over.
/// Errors, with paths on disk: "describe.unreadable" (ErrorCode::io) for a folder or file that cannot be read or is
/// over 1 MiB, "describe.duplicate" where the tree already has the name.
Status read_user_folder(const std::filesystem::path& folder, Registry& registry);

}  // namespace relievo
