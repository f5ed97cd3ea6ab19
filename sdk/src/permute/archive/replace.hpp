/// Puts a finished archive where it belongs: all of it at once, or not at all.
#pragma once

#include <filesystem>

#include "permute/archive/contents.hpp"

namespace relievo::archive {

/// A folder, a pipe or a device is not to be replaced by a file. Errors: "archive.write".
Status check_replaceable(const std::filesystem::path& path);

/// Writes the archive beside `path` and renames it. Errors: "archive.write".
Status replace(const std::filesystem::path& path, const Layout& layout, const Spool& spool);

}  // namespace relievo::archive
