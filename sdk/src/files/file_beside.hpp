/// Files by descriptor, and temporary ones beside those that they are to replace.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace relievo::files {

/// An open file, closed in the end.
class File {
 public:
  File() = default;
  explicit File(int descriptor) : descriptor_(descriptor) {}
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  ~File();

  explicit operator bool() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }

  /// False, with errno, when not all of it could be written.
  bool write_at(std::uint64_t offset, std::string_view bytes) const;
  /// False, with errno, when there is less.
  bool read_at(std::uint64_t offset, std::span<char> bytes) const;
  /// False, with errno, when the system reports a write that failed late, as network file systems do at a close. The
  /// file stays open.
  bool settle() const;

 private:
  int descriptor_ = -1;
};

/// Where a symbolic link leads, for what is replaced is the file and not the link; else the path itself.
std::filesystem::path link_target(const std::filesystem::path& path);

/// A new, empty file beside `path`, of a name that nobody else has; `name` receives it. While it is open it is locked,
/// so that what a killed process left can be told from what is being written, on any machine.
File create_beside(const std::filesystem::path& path, std::string_view suffix, std::filesystem::path& name);

/// A file in the folder of `path` that vanishes with the process, however that ends. `can_be_named`: until it is
/// named.
File create_unnamed(const std::filesystem::path& path, bool& can_be_named);

/// Names an unnamed file, with a name as `create_beside` would give; false, with errno, when that fails.
bool give_name(const File& file, const std::filesystem::path& path, std::string_view suffix,
               std::filesystem::path& name);

/// Removes what killed processes left beside `path`: files that `create_beside` named and nobody holds open.
void sweep_beside(const std::filesystem::path& path);

}  // namespace relievo::files
