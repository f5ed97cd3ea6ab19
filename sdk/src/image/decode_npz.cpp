#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>

#include "files/whole_file.hpp"
#include "image/array.hpp"

namespace relievo {

namespace {

struct ZipClose {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct EntryClose {
  void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};
using Archive = std::unique_ptr<zip_t, ZipClose>;
using Entry = std::unique_ptr<zip_file_t, EntryClose>;

Archive open_archive(Bytes bytes) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  zip_t* archive = source != nullptr ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr;
  if (archive == nullptr && source != nullptr) zip_source_free(source);
  zip_error_fini(&error);
  return Archive(archive);
}

/// Up to `count` bytes of an entry from its beginning, or nothing when the archive is damaged there.
std::optional<std::vector<std::uint8_t>> read_entry(zip_t* archive, zip_uint64_t index, std::size_t count) {
  const Entry entry(zip_fopen_index(archive, index, 0));
  if (!entry) return std::nullopt;
  std::vector<std::uint8_t> bytes(count);
  std::size_t size = 0;
  while (size < count) {
    const zip_int64_t got = zip_fread(entry.get(), bytes.data() + size, count - size);
    if (got < 0) return std::nullopt;
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  // Reading past the end is what makes libzip compare the checksum.
  std::uint8_t beyond = 0;
  if (size == count && zip_fread(entry.get(), &beyond, 1) < 0) return std::nullopt;
  bytes.resize(size);
  return bytes;
}

struct Candidate {
  zip_uint64_t index = 0;
  std::string name;
  std::size_t size = 0;  ///< bytes of the whole entry that its header promises
};

std::size_t promised_size(const NpyHeader& header, const NumberArray& array) {
  return header.data_offset + static_cast<std::size_t>(array.rows) * static_cast<std::size_t>(array.columns) *
                                  static_cast<std::size_t>(array.size);
}

/// The 2D arrays with more than one element, by their headers alone.
Result<std::vector<Candidate>> find_candidates(const ImageSource& source, zip_t* archive) {
  constexpr std::size_t header_limit = 65536;
  std::vector<Candidate> candidates;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i) {
    const auto index = static_cast<zip_uint64_t>(i);
    const char* name = zip_get_name(archive, index, 0);
    if (name == nullptr || !std::string_view(name).ends_with(".npy")) continue;
    const auto head = read_entry(archive, index, header_limit);
    if (!head)
      return file_error(source.path, "image.corrupt", fmt::format("is truncated or corrupt in its array '{}'", name));
    const auto header = parse_npy_header({source.path, *head});
    if (!header) return tl::unexpected(header.error());
    const auto& shape = header->shape;
    if (shape.size() != 2 || (shape[0] == 1 && shape[1] == 1) || shape[0] == 0 || shape[1] == 0) continue;
    const auto array = describe_array(source.path, *header);
    if (!array) return tl::unexpected(array.error());
    candidates.push_back({index, name, promised_size(*header, *array)});
  }
  return candidates;
}

}  // namespace

bool is_zip(Bytes bytes) {
  return bytes.size() >= 4 && bytes[0] == 'P' && bytes[1] == 'K' && bytes[2] == 3 && bytes[3] == 4;
}

Result<NumberArray> decode_npz(const ImageSource& source) {
  const Archive archive = open_archive(source.bytes);
  if (!archive) return file_error(source.path, "image.corrupt", "is truncated or corrupt: it is no whole zip archive");
  const auto candidates = find_candidates(source, archive.get());
  if (!candidates) return tl::unexpected(candidates.error());
  if (candidates->size() != 1) {
    std::string names;
    for (const Candidate& candidate : *candidates)
      names += fmt::format("{}'{}'", names.empty() ? ": " : ", ", candidate.name);
    return file_error(source.path, "image.format",
                      fmt::format("holds {} two-dimensional arrays{}; one is expected", candidates->size(), names));
  }
  const Candidate& chosen = candidates->front();
  zip_stat_t stat;
  if (zip_stat_index(archive.get(), chosen.index, 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0 ||
      stat.size < chosen.size) {
    return file_error(source.path, "image.truncated", fmt::format("is truncated in its array '{}'", chosen.name));
  }
  // Deflate makes at most 1032 bytes of one.
  if (chosen.size / 1032 > source.bytes.size()) {
    return file_error(source.path, "image.corrupt",
                      fmt::format("is corrupt: it cannot hold its array '{}'", chosen.name));
  }
  const auto bytes = read_entry(archive.get(), chosen.index, chosen.size);
  if (!bytes || bytes->size() < chosen.size) {
    return file_error(source.path, "image.corrupt",
                      fmt::format("is truncated or corrupt in its array '{}'", chosen.name));
  }
  return decode_npy({source.path, *bytes});
}

}  // namespace relievo
