#include "permute/archive/mapping.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "files/file_beside.hpp"
#include "files/whole_file.hpp"

namespace relievo::archive {

namespace fs = std::filesystem;

Mapping::Mapping(Mapping&& other) noexcept
    : bytes_(std::exchange(other.bytes_, {})), owned_(std::exchange(other.owned_, false)) {}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  std::swap(owned_, other.owned_);
  return *this;
}

Mapping::~Mapping() {
  if (owned_) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

Result<Mapping> Mapping::of_file(const fs::path& path) {
  const auto failure = [&path](const std::string& reason) {
    return file_error(path, "archive.open", fmt::format("cannot be opened: {}", reason));
  };
  // A pipe would block until somebody writes to it.
  const files::File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!file || ::fstat(file.descriptor(), &status) != 0) return failure(std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return failure("it is no regular file");
  Mapping mapping;
  if (status.st_size == 0) return mapping;
  const auto size = static_cast<std::size_t>(status.st_size);
  void* address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.descriptor(), 0);
  if (address == MAP_FAILED) return failure(std::strerror(errno));
  mapping.bytes_ = {static_cast<const std::byte*>(address), size};
  mapping.owned_ = true;
  return mapping;
}

}  // namespace relievo::archive
