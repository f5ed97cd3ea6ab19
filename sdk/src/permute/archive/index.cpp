#include "permute/archive/index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace relievo::archive {

namespace {

tl::unexpected<Error> format_failure(const std::string& name, const std::string& reason) {
  return fail(ErrorCode::io, "archive.format", fmt::format("'{}' is no intact archive: {}", name, reason), name);
}

template <class Record>
bool view(std::span<const std::byte> file, const Header& header, Section section, std::span<const Record>& records) {
  const SectionRecord& at = header.sections[static_cast<std::size_t>(section)];
  if (at.size % sizeof(Record) != 0) return false;
  records = {reinterpret_cast<const Record*>(file.data() + at.offset),
             static_cast<std::size_t>(at.size / sizeof(Record))};
  return true;
}

/// Magic, version, byte order, sizes and hash.
Status check_header(std::span<const std::byte> file, const Header& header, const std::string& name) {
  if (std::string_view(header.magic.data(), header.magic.size()) != kMagic)
    return format_failure(name, "it does not begin as one");
  if (header.endian_mark != kEndianMark) return format_failure(name, "its byte order is not little-endian");
  if (header.version != kVersion) {
    return fail(
        ErrorCode::io, "archive.version",
        fmt::format("'{}' is an archive of version {}; this program reads version {}", name, header.version, kVersion),
        name);
  }
  if (header.file_size != file.size())
    return format_failure(name, fmt::format("it has {} bytes; expected {}", file.size(), header.file_size));
  if (header.index_offset < sizeof(Header) || header.index_offset > file.size() ||
      header.index_offset % kAlignment != 0)
    return format_failure(name, fmt::format("its index is at {}", header.index_offset));
  const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
  const std::string_view head = bytes.substr(kHashedFrom, sizeof(Header) - kHashedFrom);
  if (hash64(head, bytes.substr(static_cast<std::size_t>(header.index_offset))) != header.index_hash)
    return format_failure(name, "the hash of its index differs");
  return {};
}

bool is_zero(std::span<const std::byte> bytes) {
  return std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{0}; });
}

/// The sections lie one after the other, aligned, with zeros between, and end the file.
bool sections_fit(std::span<const std::byte> file, const Header& header) {
  if (header.section_count != kSectionCount || header.reserved != 0) return false;
  std::uint64_t expected = header.index_offset;
  for (const SectionRecord& section : header.sections) {
    if (section.offset != expected || section.size > file.size() - expected) return false;
    const std::uint64_t end = expected + section.size;
    expected = aligned(end);
    if (expected > file.size()) return false;
    if (!is_zero(file.subspan(end, expected - end))) return false;
  }
  return expected == file.size();
}

bool view_sections(const Header& header, Index& index) {
  const SectionRecord& text = header.sections[static_cast<std::size_t>(Section::text)];
  index.text = {reinterpret_cast<const char*>(index.file.data()) + text.offset, static_cast<std::size_t>(text.size)};
  return view(index.file, header, Section::strings, index.strings) &&
         view(index.file, header, Section::axes, index.axis_records) &&
         view(index.file, header, Section::targets, index.target_records) &&
         view(index.file, header, Section::values, index.values) &&
         view(index.file, header, Section::keys, index.keys) && view(index.file, header, Section::slots, index.slots) &&
         view(index.file, header, Section::entries, index.entries) &&
         view(index.file, header, Section::programs, index.programs) &&
         view(index.file, header, Section::outputs, index.outputs) &&
         view(index.file, header, Section::absences, index.absences) &&
         view(index.file, header, Section::absent_targets, index.absent_targets) &&
         view(index.file, header, Section::blobs, index.blobs);
}

/// Each check relies on those before it.
std::string fault_of(Index& index) {
  std::string fault = fault_of_axes(index);
  if (fault.empty()) fault = fault_of_targets(index);
  if (fault.empty()) fault = fault_of_entries(index);
  if (fault.empty()) fault = fault_of_keys(index);
  if (fault.empty()) fault = fault_of_programs(index);
  if (fault.empty()) fault = fault_of_absences(index);
  if (fault.empty()) fault = fault_of_blobs(index);
  return fault;
}

}  // namespace

Result<Index> read_index(std::span<const std::byte> file, const std::string& name) {
  if (reinterpret_cast<std::uintptr_t>(file.data()) % kAlignment != 0)
    return format_failure(name, "its bytes are not aligned to 8 in memory");
  if (file.size() < sizeof(Header)) return format_failure(name, fmt::format("it has only {} bytes", file.size()));
  Header header{};
  std::memcpy(&header, file.data(), sizeof header);
  if (Status status = check_header(file, header, name); !status) return tl::unexpected(status.error());
  Index index;
  index.file = file;
  index.blobs_end = header.index_offset;
  if (!sections_fit(file, header) || !view_sections(header, index))
    return format_failure(name, "its sections do not fit");
  if (const std::string fault = fault_of(index); !fault.empty()) return format_failure(name, fault);
  return index;
}

}  // namespace relievo::archive
