#include "permute/cache/folder.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <optional>

namespace relievo {

namespace {

/// Nothing when it is unset or empty.
std::optional<std::filesystem::path> path_variable(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return std::filesystem::path(value);
}

}  // namespace

std::filesystem::path default_cache_folder() {
  if (const auto own = path_variable("RELIEVO_CACHE_DIR")) return *own;
  // The XDG base directory specification: a relative path is invalid and is ignored.
  if (const auto base = path_variable("XDG_CACHE_HOME"); base && base->is_absolute()) return *base / "relievo";
  if (const auto home = path_variable("HOME")) return *home / ".cache" / "relievo";
  return {};
}

}  // namespace relievo

namespace relievo::cache {

namespace {

constexpr std::string_view kEntryEnding = ".entry", kTemporaryEnding = ".tmp";
constexpr std::int64_t kUnfinishedAge = 600;  // s; a writer needs less than one

using Directory = std::unique_ptr<DIR, int (*)(DIR*)>;

Directory open_directory(const std::string& path) {
  return {::opendir(path.c_str()), &::closedir};
}

tl::unexpected<Error> folder_error(std::string_view what, const std::string& folder, int reason) {
  return fail(ErrorCode::io, "cache.folder", fmt::format("the cache folder {}: {}", what, std::strerror(reason)),
              folder);
}

bool is_lower_hex(std::string_view text) {
  return text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::uint64_t parse_hex(std::string_view digits) {
  std::uint64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  return value;
}

/// The writer's process in "30 digits.PID-NUMBER.tmp"; nothing for any other name.
std::optional<pid_t> temporary_writer(std::string_view name) {
  if (name.size() < 30 || !is_lower_hex(name.substr(0, 30)) || !name.ends_with(kTemporaryEnding)) return std::nullopt;
  name.remove_prefix(30);
  name.remove_suffix(kTemporaryEnding.size());
  const std::size_t dash = name.find('-');
  if (dash == std::string_view::npos || name.front() != '.') return std::nullopt;
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (!is_number(name.substr(1, dash - 1)) || !is_number(name.substr(dash + 1))) return std::nullopt;
  pid_t writer = 0;
  std::from_chars(name.data() + 1, name.data() + dash, writer);
  return writer;
}

/// A process of another machine or container seems gone though it lives: it then writes its entry anew.
bool is_dead(pid_t writer, const struct stat& file) {
  if (std::time(nullptr) - file.st_mtim.tv_sec > kUnfinishedAge) return true;
  return writer <= 0 || (::kill(writer, 0) != 0 && errno == ESRCH);
}

void add_file(FolderListing& listing, const std::string& folder, std::string_view digits, DIR* directory,
              const char* file_name) {
  const std::string_view name = file_name;
  const bool is_entry =
      name.size() == 30 + kEntryEnding.size() && name.ends_with(kEntryEnding) && is_lower_hex(name.substr(0, 30));
  const std::optional<pid_t> writer = is_entry ? std::nullopt : temporary_writer(name);
  if (!is_entry && !writer) return;
  struct stat file {};
  if (::fstatat(::dirfd(directory), file_name, &file, AT_SYMLINK_NOFOLLOW) != 0) return;  // gone meanwhile
  if (!S_ISREG(file.st_mode) && !S_ISLNK(file.st_mode)) return;
  if (writer) {
    listing.temporaries.push_back({fmt::format("{}/{}/{}", folder, digits, name), is_dead(*writer, file)});
    return;
  }
  const std::string hex = fmt::format("{}{}", digits, name.substr(0, 30));
  const CacheKey key{parse_hex(std::string_view(hex).substr(0, 16)), parse_hex(std::string_view(hex).substr(16))};
  listing.entries.push_back({key, static_cast<std::uint64_t>(file.st_size),
                             std::int64_t{file.st_mtim.tv_sec} * 1'000'000'000 + file.st_mtim.tv_nsec});
}

}  // namespace

Result<std::string> prepare_folder(const std::filesystem::path& given) {
  const std::filesystem::path chosen = given.empty() ? default_cache_folder() : given;
  if (chosen.empty()) {
    return fail(ErrorCode::io, "cache.folder",
                "the cache has no folder; expected one in the options, in RELIEVO_CACHE_DIR, or HOME to be set");
  }
  std::error_code error;
  const std::string folder = std::filesystem::absolute(chosen, error).string();
  if (error) return folder_error("has no absolute path", chosen.string(), error.value());
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder, error) && !error)
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) return folder_error("cannot be made", folder, error.value());
  if (::faccessat(AT_FDCWD, folder.c_str(), R_OK | W_OK | X_OK, AT_EACCESS) != 0)
    return folder_error("cannot be written", folder, errno);
  return folder;
}

std::string entry_path(const std::string& folder, const CacheKey& key) {
  const std::string digits = to_string(key);
  std::string path;
  path.reserve(folder.size() + digits.size() + 2 + kEntryEnding.size());
  path.append(folder).append("/").append(digits, 0, 2).append("/").append(digits, 2).append(kEntryEnding);
  return path;
}

std::string temporary_path(const std::string& entry_path) {
  static std::atomic<std::uint64_t> number{0};
  return fmt::format("{}.{}-{}{}", std::string_view(entry_path).substr(0, entry_path.size() - kEntryEnding.size()),
                     ::getpid(), number++, kTemporaryEnding);
}

Result<FolderListing> list_folder(const std::string& folder) {
  FolderListing listing;
  const Directory top = open_directory(folder);
  if (!top && errno == ENOENT) return listing;
  if (!top) return folder_error("cannot be read", folder, errno);
  while (const dirent* child = ::readdir(top.get())) {
    const std::string digits = child->d_name;
    if (digits.size() != 2 || !is_lower_hex(digits)) continue;
    const Directory directory = open_directory(fmt::format("{}/{}", folder, digits));
    if (!directory) continue;
    while (const dirent* file = ::readdir(directory.get()))
      add_file(listing, folder, digits, directory.get(), file->d_name);
  }
  return listing;
}

std::uint64_t sweep_dead(const std::vector<TemporaryFile>& temporaries) {
  std::uint64_t swept = 0;
  for (const TemporaryFile& file : temporaries) {
    if (file.dead && ::unlink(file.path.c_str()) == 0) ++swept;
  }
  return swept;
}

}  // namespace relievo::cache
