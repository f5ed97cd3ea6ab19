#include "permute/cache/usage.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <xxhash.h>
#include <array>
#include <cerrno>
#include <string_view>
#include <thread>

#include "permute/cache/little_endian.hpp"
#include "permute/cache/write.hpp"

namespace relievo::cache {

namespace {

constexpr std::string_view kMagic = "RlvUsage";
constexpr std::size_t kRecordSize = 32;  // magic, bytes, generation, hash of these

bool lock_within(int fd, std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    // A file system without locks is used without: the bound is then kept by each process for itself.
    if (errno != EWOULDBLOCK) return true;
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  return true;
}

std::uint64_t record_hash(const char* record) {
  return XXH3_64bits(record, kRecordSize - 8);
}

}  // namespace

std::uint64_t new_generation() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

std::optional<UsageFile> UsageFile::lock(const std::string& folder, Absent absent, std::chrono::milliseconds patience) {
  const int make = absent == Absent::make ? O_CREAT : 0;
  FileDescriptor file(::open((folder + "/usage").c_str(), O_RDWR | make | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666));
  if (!file || !lock_within(file.get(), patience)) return std::nullopt;
  return UsageFile(std::move(file));
}

std::optional<Usage> UsageFile::read() const {
  std::array<char, kRecordSize> record{};
  if (::pread(file_.get(), record.data(), record.size(), 0) != static_cast<ssize_t>(record.size())) return std::nullopt;
  if (std::string_view(record.data(), kMagic.size()) != kMagic || get_u64(&record[24]) != record_hash(record.data()))
    return std::nullopt;
  return Usage{get_u64(&record[8]), get_u64(&record[16])};
}

void UsageFile::write(const Usage& usage) const {
  std::array<char, kRecordSize> record{};
  kMagic.copy(record.data(), kMagic.size());
  put_u64(&record[8], usage.bytes);
  put_u64(&record[16], usage.generation);
  put_u64(&record[24], record_hash(record.data()));
  // What fails here leaves a count that does not read, and so is made anew.
  if (::lseek(file_.get(), 0, SEEK_SET) == 0) (void)write_all(file_.get(), {record.data(), record.size()});
}

}  // namespace relievo::cache
