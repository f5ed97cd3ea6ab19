/// Paths of the source tree: relative, with / between folders, as they stand in #include and in diagnostics.
#pragma once

#include <string>
#include <string_view>

namespace relievo {

/// "techniques/relief" of "techniques/relief/technique.toml"; empty without a folder.
std::string folder_of(std::string_view path);

/// What follows the last /.
std::string file_name_of(std::string_view path);

/// `relative` seen from `folder`, without "." and ".." parts. Empty when it leaves the folder, is absolute, names no
/// file, or has a character that no portable path has (\ : and control characters).
std::string join_source_path(std::string_view folder, std::string_view relative);

}  // namespace relievo
