#include "describe/source_path.hpp"

#include <algorithm>
#include <vector>

namespace relievo {

std::string folder_of(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return std::string(slash == path.npos ? std::string_view() : path.substr(0, slash));
}

std::string file_name_of(std::string_view path) {
  return std::string(path.substr(path.rfind('/') + 1));
}

std::string join_source_path(std::string_view folder, std::string_view relative) {
  const auto is_unportable = [](char c) { return c == '\\' || c == ':' || static_cast<unsigned char>(c) < 0x20; };
  if (relative.starts_with('/') || std::any_of(relative.begin(), relative.end(), is_unportable)) return {};
  std::vector<std::string_view> parts;
  while (!relative.empty()) {
    const std::size_t slash = std::min(relative.find('/'), relative.size());
    const std::string_view part = relative.substr(0, slash);
    relative.remove_prefix(std::min(slash + 1, relative.size()));
    if (part.empty() || part == ".") continue;
    if (part != "..") {
      parts.push_back(part);
    } else if (parts.empty()) {
      return {};
    } else {
      parts.pop_back();
    }
  }
  if (parts.empty()) return {};
  std::string path(folder);
  for (const std::string_view part : parts) {
    if (!path.empty()) path += '/';
    path += part;
  }
  return path;
}

}  // namespace relievo
