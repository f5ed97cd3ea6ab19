#include "compose/include.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <optional>

namespace relievo {

namespace {

/// The name inside `#include "name"`, if the line is one.
std::optional<std::string> include_name(std::string_view line) {
  std::size_t at = line.find_first_not_of(" \t");
  if (at == std::string_view::npos || line[at] != '#') return std::nullopt;
  at = line.find_first_not_of(" \t", at + 1);
  constexpr std::string_view keyword = "include";
  if (at == std::string_view::npos || line.substr(at, keyword.size()) != keyword) return std::nullopt;
  std::size_t open = line.find('"', at);
  std::size_t close = open == std::string_view::npos ? open : line.find('"', open + 1);
  if (close == std::string_view::npos) return std::string();
  return std::string(line.substr(open + 1, close - open - 1));
}

std::string folder_of(const std::string& path) {
  std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? std::string() : path.substr(0, slash + 1);
}

}  // namespace

Result<std::string> SourceExpander::resolve(const std::string& includer, int line, const std::string& name) const {
  std::string folder = folder_of(includer);
  std::string local = std::filesystem::path(folder + name).lexically_normal().generic_string();
  bool escapes = name.empty() || name.front() == '/' || !local.starts_with(folder);
  if (!escapes && tree_.contains(local)) return local;
  std::string shared = std::filesystem::path(name).lexically_normal().generic_string();
  if (shared.starts_with("shaders/lib/") && tree_.contains(shared)) return shared;
  if (escapes) {
    return fail(ErrorCode::compile, "compose.include-escapes",
                fmt::format("#include \"{}\" leaves the folder '{}'; expected a file of that folder or of shaders/lib/",
                            name, folder),
                includer, line, 1);
  }
  std::vector<std::string> known;
  for (const auto& [path, text] : tree_) {
    if (path.starts_with(folder)) known.push_back(path.substr(folder.size()));
    if (path.starts_with("shaders/lib/")) known.push_back(path);
  }
  std::string nearest = nearest_name(name, known);
  return fail(ErrorCode::compile, "compose.missing-include",
              fmt::format("#include \"{}\" names no file of '{}' or of shaders/lib/{}", name, folder,
                          nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)),
              includer, line, 1);
}

Status SourceExpander::append(const std::string& path, std::string& text) {
  if (std::find(files_.begin(), files_.end(), path) != files_.end()) return {};
  files_.push_back(path);
  open_.push_back(path);
  std::string_view content = tree_.find(path)->second;
  text += fmt::format("#line 1 \"{}\"\n", path);
  for (int line = 1; !content.empty(); ++line) {
    std::size_t end = content.find('\n');
    std::string_view current = content.substr(0, end);
    content = end == std::string_view::npos ? std::string_view() : content.substr(end + 1);
    std::optional<std::string> name = include_name(current);
    if (!name) {
      text += current;
      text += '\n';
      continue;
    }
    Result<std::string> target = resolve(path, line, *name);
    if (!target) return tl::unexpected(target.error());
    if (std::find(open_.begin(), open_.end(), *target) != open_.end()) {
      return fail(ErrorCode::compile, "compose.include-cycle",
                  fmt::format("#include \"{}\" includes itself: {} -> {}", *name, fmt::join(open_, " -> "), *target),
                  path, line, 1);
    }
    if (Status status = append(*target, text); !status) return status;
    text += fmt::format("#line {} \"{}\"\n", line + 1, path);
  }
  open_.pop_back();
  return {};
}

Result<std::string> SourceExpander::expand(const std::string& path) {
  if (!tree_.contains(path)) {
    return fail(ErrorCode::compile, "compose.missing-module",
                fmt::format("module '{}' is not in the source tree", path), path);
  }
  std::string text;
  if (Status status = append(path, text); !status) return tl::unexpected(status.error());
  return text;
}

}  // namespace relievo
