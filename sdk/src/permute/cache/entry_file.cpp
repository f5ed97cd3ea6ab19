#include "permute/cache/entry_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <new>

#include "permute/cache/file_descriptor.hpp"
#include "permute/cache/folder.hpp"
#include "permute/cache/write.hpp"

namespace relievo::cache {

namespace {

constexpr std::int64_t kTouchAge = 300;  // s; eviction need not know better, and most hits then cost nothing

/// Reads until both are full. A file that ends before is short by what it lacks.
bool read_whole(int fd, EntryHeader& header, std::string& payload) {
  std::size_t done = 0;
  const std::size_t total = header.size() + payload.size();
  while (done < total) {
    iovec parts[2];
    int count = 0;
    if (done < header.size()) parts[count++] = {header.data() + done, header.size() - done};
    const std::size_t skip = done < header.size() ? 0 : done - header.size();
    if (skip < payload.size()) parts[count++] = {payload.data() + skip, payload.size() - skip};
    const ssize_t got = ::readv(fd, parts, count);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      if (got == 0) errno = EIO;
      return false;
    }
    done += static_cast<std::size_t>(got);
  }
  return true;
}

/// Removes the damaged file and none that a writer has put in its place meanwhile: that one is moved back. `damaged`
/// must be held open (or be a link), so that its number is not given to another file.
void remove_damaged(const std::string& path, const struct stat& damaged) {
  const std::string aside = temporary_path(path);
  if (std::rename(path.c_str(), aside.c_str()) != 0) return;
  struct stat moved {};
  const bool same =
      ::lstat(aside.c_str(), &moved) == 0 && moved.st_dev == damaged.st_dev && moved.st_ino == damaged.st_ino;
  if (same) {
    ::unlink(aside.c_str());
  } else {
    std::rename(aside.c_str(), path.c_str());
  }
}

EntryRead unreadable(int reason) {
  return {EntryRead::State::unreadable, {}, fmt::format("it cannot be read: {}", std::strerror(reason))};
}

EntryRead open_failed(const std::string& path, int reason) {
  if (reason == ENOENT || reason == ENOTDIR) return {};
  struct stat link {};
  if (reason != ELOOP || ::lstat(path.c_str(), &link) != 0 || !S_ISLNK(link.st_mode)) return unreadable(reason);
  remove_damaged(path, link);
  return {EntryRead::State::damaged, {}, "it is a symbolic link; expected a file"};
}

EntryRead read_open(const std::string& path, int fd, const struct stat& file, const CacheKey& key) {
  EntryRead read;
  const auto size = static_cast<std::uint64_t>(file.st_size);
  if (size < kHeaderSize || size > kHeaderSize + kMaxPayload) {
    read.fault = fmt::format("it has {} bytes; expected {} to {}", size, kHeaderSize, kHeaderSize + kMaxPayload);
  } else {
    EntryHeader header;
    read.payload.resize(size - kHeaderSize);
    if (!read_whole(fd, header, read.payload)) return unreadable(errno);
    read.fault = entry_fault({header.data(), header.size()}, read.payload, key);
  }
  if (read.fault.empty()) {
    read.state = EntryRead::State::sound;
    return read;
  }
  remove_damaged(path, file);
  return {EntryRead::State::damaged, {}, std::move(read.fault)};
}

int make_parent(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
  return error.value();
}

/// One attempt under one temporary name.
int write_and_rename(const std::string& path, std::string_view header, std::string_view payload) {
  const std::string temporary = temporary_path(path);
  FileDescriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (!file) return errno;
  int failed = write_all(file.get(), header, payload);
  if (!file.close() && failed == 0) failed = errno;
  if (failed == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) failed = errno;
  if (failed != 0) ::unlink(temporary.c_str());
  return failed;
}

}  // namespace

EntryRead read_entry_file(const std::string& path, const CacheKey& key, Touch touch) {
  // Not blocking: a pipe in an entry's place would hold us up for ever.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!file) return open_failed(path, errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return unreadable(errno);
  if (!S_ISREG(status.st_mode)) return {EntryRead::State::unreadable, {}, "it is not a file"};
  try {
    EntryRead read = read_open(path, file.get(), status, key);
    if (touch == Touch::yes && read.state == EntryRead::State::sound &&
        std::time(nullptr) - status.st_mtim.tv_sec > kTouchAge) {
      ::futimens(file.get(), nullptr);
    }
    return read;
  } catch (const std::bad_alloc&) {
    return unreadable(ENOMEM);
  }
}

int write_entry_file(const std::string& path, std::string_view header, std::string_view payload) {
  int failed = 0;
  // A second attempt where the folder is missing or was cleared, or another process of our number has the name.
  for (int attempt = 0; attempt < 4; ++attempt) {
    failed = write_and_rename(path, header, payload);
    if (failed != ENOENT && failed != EEXIST) break;
    if (const int no_parent = failed == ENOENT ? make_parent(path) : 0; no_parent != 0) return no_parent;
  }
  return failed;
}

}  // namespace relievo::cache
