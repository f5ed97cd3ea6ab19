#include "permute/archive/replace.hpp"

#include <algorithm>
#include <cerrno>

#include "files/whole_file.hpp"

namespace relievo::archive {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 20;

/// A file that is written from front to end, in large pieces.
class Output {
 public:
  explicit Output(const files::File& file) : file_(file) { buffer_.reserve(kBufferSize); }

  bool append(std::string_view bytes) {
    if (buffer_.size() + bytes.size() > kBufferSize && !flush()) return false;
    if (bytes.size() < kBufferSize) {
      buffer_ += bytes;
      return true;
    }
    if (!file_.write_at(offset_, bytes)) return false;
    offset_ += bytes.size();
    return true;
  }

  /// Appends a blob of the spool, padded.
  bool append(const files::File& spool, const SpooledBlob& blob) {
    for (std::uint64_t done = 0; done < blob.size;) {
      if (buffer_.size() == kBufferSize && !flush()) return false;
      const std::size_t held = buffer_.size();
      const std::size_t size = std::min<std::uint64_t>(blob.size - done, kBufferSize - held);
      buffer_.resize(held + size);
      if (!spool.read_at(blob.offset + done, std::span(buffer_).subspan(held))) return false;
      done += size;
    }
    return append(std::string_view("\0\0\0\0\0\0\0", aligned(blob.size) - blob.size));
  }

  bool flush() {
    if (!file_.write_at(offset_, buffer_)) return false;
    offset_ += buffer_.size();
    buffer_.clear();
    return true;
  }

 private:
  const files::File& file_;
  std::string buffer_;
  std::uint64_t offset_ = 0;
};

bool write(const files::File& file, const Layout& layout, const Spool& spool) {
  Output output(file);
  if (!output.append(layout.header)) return false;
  for (const std::uint32_t blob : layout.blobs) {
    if (!output.append(spool.file(), spool.blobs()[blob])) return false;
  }
  return output.append(layout.index) && output.flush() && file.settle();
}

/// The spool has the blobs where they belong: it lacks only what is around them, and a name.
bool complete(const Spool& spool, const Layout& layout, const fs::path& path, fs::path& temporary) {
  return spool.file().write_at(0, layout.header) && spool.file().write_at(layout.index_offset, layout.index) &&
         files::give_name(spool.file(), path, ".tmp", temporary);
}

/// False, with errno, when the archive could not be written under a temporary name. `file` may hold it open.
bool write_beside(const fs::path& path, const Layout& layout, const Spool& spool, fs::path& temporary,
                  files::File& file) {
  if (layout.is_spool && spool.can_be_named() && complete(spool, layout, path, temporary)) return true;
  file = files::create_beside(path, ".tmp", temporary);
  return file && write(file, layout, spool);
}

}  // namespace

Status check_replaceable(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!path.has_filename() || fs::is_directory(status))
    return file_error(path, "archive.write", "is a folder; expected the name of a file");
  if (fs::is_symlink(files::link_target(path), ignored))
    return file_error(path, "archive.write", "is a link that leads nowhere but to links");
  if (fs::exists(status) && !fs::is_regular_file(status))
    return file_error(path, "archive.write", "is no regular file, and is not replaced");
  return {};
}

Status replace(const fs::path& path, const Layout& layout, const Spool& spool) {
  fs::path temporary;
  files::File file;  // locked until it has its name
  Status status;
  if (!write_beside(path, layout, spool, temporary, file)) status = write_failure(path);
  std::error_code failed, ignored;
  if (status) fs::rename(temporary, path, failed);
  if (failed) {
    errno = failed.value();
    status = write_failure(path);
  }
  if (!status && !temporary.empty()) fs::remove(temporary, ignored);
  return status;
}

}  // namespace relievo::archive
