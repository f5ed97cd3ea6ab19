#include "files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>
#include <system_error>

#include "files/file_beside.hpp"

namespace relievo {

namespace fs = std::filesystem;

namespace {

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, Closer>;

/// Empty when all is well, else the system's reason.
std::string append(const fs::path& path, std::span<const std::uint8_t> bytes) {
  errno = 0;
  FileHandle file(std::fopen(path.string().c_str(), "ab"));
  if (!file) return std::strerror(errno);
  const bool written = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  const bool closed = std::fclose(file.release()) == 0;
  return written && closed ? std::string() : std::strerror(errno);
}

/// No image of largest_height_map_extent has more; a device may never end.
constexpr std::size_t largest_file = std::size_t{8} << 30;

/// To the end of the file, or a little beyond `largest_file`.
std::vector<std::uint8_t> read_all(std::FILE* file, std::uintmax_t expected) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(std::min<std::uintmax_t>(expected, largest_file)));
  std::uint8_t block[65536];
  while (const std::size_t count = std::fread(block, 1, sizeof block, file)) {
    bytes.insert(bytes.end(), block, block + count);
    if (bytes.size() > largest_file) break;
  }
  return bytes;
}

/// Empty when all is well, else the system's reason.
std::string replace(const fs::path& path, std::span<const std::uint8_t> bytes) {
  std::error_code not_there;
  if (fs::is_symlink(path, not_there)) return std::strerror(ELOOP);  // where links end, there is none
  files::sweep_beside(path);
  fs::path temporary;
  const files::File file = files::create_beside(path, ".tmp", temporary);
  if (!file) return std::strerror(errno);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::error_code failed, ignored;
  if (file.write_at(0, text) && file.settle()) {
    fs::rename(temporary, path, failed);
  } else {
    failed.assign(errno, std::generic_category());
  }
  if (!failed) return {};
  fs::remove(temporary, ignored);
  return failed.message();
}

}  // namespace

std::string short_name(const fs::path& path) {
  return path.has_filename() ? path.filename().string() : path.string();
}

tl::unexpected<Error> file_error(const fs::path& path, std::string id, const std::string& rest) {
  return fail(ErrorCode::io, std::move(id), fmt::format("'{}' {}", short_name(path), rest), path.string());
}

Result<std::vector<std::uint8_t>> read_file(const fs::path& path, const std::string& kind) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found) return file_error(path, kind + ".missing", "does not exist");
  if (fs::is_directory(status)) return file_error(path, kind + ".unreadable", "is a folder, not a file");
  errno = 0;
  FileHandle file(std::fopen(path.string().c_str(), "rb"));
  if (!file) return file_error(path, kind + ".unreadable", fmt::format("cannot be opened: {}", std::strerror(errno)));

  std::vector<std::uint8_t> bytes;
  try {
    bytes = read_all(file.get(), fs::is_regular_file(status) ? fs::file_size(path, code) : 0);
  } catch (const std::bad_alloc&) {
    return file_error(path, kind + ".memory", "cannot be read: it needs more memory than there is");
  }
  if (bytes.size() > largest_file) {
    return file_error(path, kind + ".size",
                      fmt::format("cannot be read: it has more than {} bytes", std::uintmax_t{largest_file}));
  }
  if (std::ferror(file.get())) {
    return file_error(path, kind + ".unreadable", fmt::format("cannot be read: {}", std::strerror(errno)));
  }
  if (bytes.empty()) return file_error(path, kind + ".empty", "is empty");
  return bytes;
}

bool is_written_in_place(const fs::path& path) {
  std::error_code code;
  const std::string name = fs::absolute(path, code).lexically_normal().string();
  if (name.starts_with("/dev/") || name.starts_with("/proc/")) return true;  // /dev/stdout may lead to a file
  const fs::file_status status = fs::status(path, code);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

Status write_file(const fs::path& path, std::span<const std::uint8_t> bytes, const std::string& kind) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  std::string reason;
  if (fs::is_directory(status)) {
    reason = "it is a folder";
  } else {
    reason = is_written_in_place(path) ? append(path, bytes) : replace(files::link_target(path), bytes);
  }
  if (!reason.empty()) return file_error(path, kind + ".write", fmt::format("cannot be written: {}", reason));
  return {};
}

}  // namespace relievo
