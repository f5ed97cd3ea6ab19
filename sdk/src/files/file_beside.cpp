#include "files/file_beside.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <utility>

namespace relievo::files {

namespace fs = std::filesystem;

File::File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

File& File::operator=(File&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool File::write_at(std::uint64_t offset, std::string_view bytes) const {
  // Writing beyond the limit would raise SIGXFSZ, which ends a process that does not expect it.
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      offset + bytes.size() > limit.rlim_cur) {
    errno = EFBIG;
    return false;
  }
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written == 0) errno = ENOSPC;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
  return true;
}

bool File::read_at(std::uint64_t offset, std::span<char> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count == 0) errno = EIO;
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
  return true;
}

bool File::settle() const {
  const int copy = ::dup(descriptor_);
  return copy >= 0 && ::close(copy) == 0;
}

namespace {

/// A name beside `path` that nobody else has, most likely.
fs::path fresh_name(const fs::path& path, std::string_view suffix) {
  static std::atomic<unsigned> counter{0};
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  fs::path name = path;
  name += fmt::format(".{:x}-{:x}-{:x}{}", ::getpid(), static_cast<unsigned long long>(now), counter++, suffix);
  return name;
}

constexpr int kMostAttempts = 100;

constexpr std::array<std::string_view, 2> kSuffixes = {".tmp", ".spool"};

/// "PID-TIME-NUMBER.tmp", in hexadecimal digits, after the name that it stands beside.
bool is_beside(std::string_view name, std::string_view owner) {
  if (!name.starts_with(owner) || name.substr(owner.size(), 1) != ".") return false;
  name.remove_prefix(owner.size() + 1);
  const auto suffix =
      std::find_if(kSuffixes.begin(), kSuffixes.end(), [&](std::string_view known) { return name.ends_with(known); });
  if (suffix == kSuffixes.end()) return false;
  name.remove_suffix(suffix->size());
  return name.find_first_not_of("0123456789abcdef-") == std::string_view::npos &&
         std::count(name.begin(), name.end(), '-') == 2;
}

/// False when a sweeper had it first: it has then lost its name, or is about to. Where there are no locks, nobody
/// sweeps.
bool lock(int descriptor, nlink_t names) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink == names;
}

}  // namespace

fs::path link_target(const fs::path& path) {
  constexpr int most_links = 40;  // as Linux has it
  fs::path target = path;
  std::error_code code;  // of the last question: where the links end there may be nothing
  for (int i = 0; i < most_links && fs::is_symlink(target, code); ++i) {
    const fs::path next = fs::read_symlink(target, code);
    if (code) return path;
    target = target.parent_path() / next;
  }
  return target;
}

File create_beside(const fs::path& path, std::string_view suffix, fs::path& name) {
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    name = fresh_name(path, suffix);
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno != EEXIST) return {};
    File file(descriptor);
    if (file && lock(descriptor, 1)) return file;
  }
  return {};
}

File create_unnamed(const fs::path& path, bool& can_be_named) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  File file(::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666));
  can_be_named = static_cast<bool>(file);
  if (can_be_named) return file;
  // Not every file system can: a name that is taken away at once does the same, but for good.
  fs::path name;
  file = create_beside(path, ".spool", name);
  std::error_code ignored;
  if (file) fs::remove(name, ignored);
  return file;
}

bool give_name(const File& file, const fs::path& path, std::string_view suffix, fs::path& name) {
  if (!lock(file.descriptor(), 0)) return false;
  const std::string unnamed = fmt::format("/proc/self/fd/{}", file.descriptor());
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    name = fresh_name(path, suffix);
    if (::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) return true;
    if (errno != EEXIST) return false;
  }
  return false;
}

void sweep_beside(const fs::path& path) {
  const std::string owner = path.filename();
  std::error_code error;
  fs::directory_iterator entry(path.has_parent_path() ? path.parent_path() : fs::path("."), error), end;
  for (; !error && entry != end; entry.increment(error)) {
    if (!is_beside(entry->path().filename().native(), owner)) continue;
    const File left(::open(entry->path().c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    if (left && ::flock(left.descriptor(), LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
  }
}

}  // namespace relievo::files
