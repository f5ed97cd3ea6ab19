#include "describe/user_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "describe/descriptor_place.hpp"
#include "describe/toml_document.hpp"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_file_size = 1 << 20;
constexpr int max_entries = 10000;

/// The descriptor that makes a folder a technique, map or stage, and where its files go.
struct Kind {
  const char* descriptor;
  const char* tree_folder;
};
constexpr std::array<Kind, 3> kinds = {
    {{"technique.toml", "techniques/"}, {"map.toml", "shaders/maps/"}, {"stage.toml", "shaders/stages/"}}};

tl::unexpected<Error> unreadable(const fs::path& path, const std::string& reason) {
  return fail(ErrorCode::io, "describe.unreadable",
              fmt::format("{} cannot be read: {}", quote_path(path.generic_string()), reason), path.generic_string());
}

/// Whether `path`, after every link, lies in `root`, which is canonical.
bool stays_inside(const fs::path& path, const fs::path& root) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  if (error) return false;
  return std::mismatch(root.begin(), root.end(), target.begin(), target.end()).first == root.end();
}

bool is_readable_source(const fs::path& path, const fs::path& root) {
  std::error_code error;
  return fs::is_regular_file(path, error) && stays_inside(path, root);
}

const Kind* kind_of(const fs::path& folder, const fs::path& root) {
  const auto holds = [&](const Kind& kind) { return is_readable_source(folder / kind.descriptor, root); };
  const auto found = std::find_if(kinds.begin(), kinds.end(), holds);
  return found == kinds.end() ? nullptr : &*found;
}

Result<std::string> read_source(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(max_file_size + 1, '\0');
  if (file) file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file.is_open() || file.bad()) return unreadable(path, "it does not open");
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > max_file_size) {
    return unreadable(path, fmt::format("it is longer than {} bytes, the most a source may have", max_file_size));
  }
  return text;
}

bool is_hidden(const fs::path& path) {
  return path.filename().native().starts_with('.');
}

bool is_source_name(const fs::path& path) {
  return !is_hidden(path) && (path.extension() == ".glsl" || path.extension() == ".toml");
}

/// The sources below `folder`, sorted, so that the first of several errors is always the same.
Result<std::vector<fs::path>> list_sources(const fs::path& folder, const fs::path& root) {
  std::vector<fs::path> sources;
  std::error_code error;
  int entries = 0;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (++entries > max_entries) return unreadable(folder, fmt::format("it holds more than {} files", max_entries));
    if (is_hidden(entry->path())) {
      entry.disable_recursion_pending();
    } else if (is_source_name(entry->path()) && is_readable_source(entry->path(), root)) {
      sources.push_back(entry->path());
    }
  }
  if (error) return unreadable(folder, error.message());
  std::sort(sources.begin(), sources.end());
  return sources;
}

Status check_name_is_free(const fs::path& descriptor, const std::string& prefix, const Registry& registry) {
  const auto taken = registry.sources.lower_bound(prefix);
  if (taken == registry.sources.end() || !taken->first.starts_with(prefix)) return {};
  const auto origin = registry.origins.find(taken->first);
  const std::string owner = origin == registry.origins.end() ? taken->first : origin->second;
  const Result<std::string> text = read_source(descriptor);
  const Place place = find_place(text.value_or(""), "name");
  return fail(ErrorCode::descriptor, "describe.duplicate",
              fmt::format("the name {} is already taken by {}",
                          quote(descriptor.parent_path().filename().generic_string()), quote_path(owner)),
              descriptor.generic_string(), place.line, place.column);
}

/// `name` is the folder's own, which `folder` may not end in ("." or "relief/").
Status read_descriptor_folder(const fs::path& folder, const std::string& name, const Kind& kind, const fs::path& root,
                              Registry& registry) {
  const std::string prefix = kind.tree_folder + name + "/";
  if (Status free = check_name_is_free(folder / kind.descriptor, prefix, registry); !free) return free;
  const Result<std::vector<fs::path>> sources = list_sources(folder, root);
  if (!sources) return tl::unexpected(sources.error());
  for (const fs::path& source : *sources) {
    Result<std::string> text = read_source(source);
    if (!text) return tl::unexpected(text.error());
    const std::string path = prefix + source.lexically_relative(folder).generic_string();
    registry.sources[path] = std::move(*text);
    registry.origins[path] = source.generic_string();
  }
  return {};
}

Result<std::vector<fs::path>> list_subfolders(const fs::path& folder, const fs::path& root) {
  std::vector<fs::path> subfolders;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;  // an entry that cannot be looked at is no descriptor folder
    if (is_hidden(entry->path()) || !entry->is_directory(ignored)) continue;
    if (stays_inside(entry->path(), root)) subfolders.push_back(entry->path());
  }
  if (error) return unreadable(folder, error.message());
  std::sort(subfolders.begin(), subfolders.end());
  return subfolders;
}

}  // namespace

Status read_user_folder(const fs::path& folder, Registry& registry) {
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) return unreadable(folder, error.message());
  if (!fs::is_directory(root, error)) return unreadable(folder, "it is not a folder");
  if (const Kind* kind = kind_of(folder, root)) {
    return read_descriptor_folder(folder, root.filename().generic_string(), *kind, root, registry);
  }
  const Result<std::vector<fs::path>> subfolders = list_subfolders(folder, root);
  if (!subfolders) return tl::unexpected(subfolders.error());
  for (const fs::path& subfolder : *subfolders) {
    const Kind* kind = kind_of(subfolder, root);
    if (!kind) continue;
    Status read = read_descriptor_folder(subfolder, subfolder.filename().generic_string(), *kind, root, registry);
    if (!read) return read;
  }
  return {};
}

}  // namespace relievo
