/// Archives on disk, in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "relievo/result.hpp"

namespace relievo::archive {

/// A file's bytes in memory, or somebody else's.
class Mapping {
 public:
  Mapping() = default;
  explicit Mapping(std::span<const std::byte> bytes) : bytes_(bytes) {}
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&& other) noexcept;
  ~Mapping();

  /// Errors: "archive.open".
  static Result<Mapping> of_file(const std::filesystem::path& path);
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
  bool owned_ = false;
};

}  // namespace relievo::archive
