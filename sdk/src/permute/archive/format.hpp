/// The bytes of an archive: docs/archive.md says the same for other languages.
#pragma once

#include <xxhash.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace relievo::archive {

static_assert(std::endian::native == std::endian::little, "archives are little-endian, and used as they lie in memory");

constexpr std::string_view kMagic{"RELIEVO\x1a", 8};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kEndianMark = 0x01020304;
constexpr std::uint32_t kNone = 0xffffffff;  ///< an empty slot of the key table; an entry without absent targets
constexpr std::size_t kAlignment = 8;        ///< of the file, of every section and of every blob

/// In the order in which they lie in the file.
enum class Section : std::size_t {
  text,            ///< bytes of every string, one after the other
  strings,         ///< StringRecord: axis by axis its name and values, then the reasons
  axes,            ///< AxisRecord
  targets,         ///< TargetRecord, ascending
  values,          ///< u16 an axis and entry; entries ascend by them
  keys,            ///< u64 an entry
  slots,           ///< u32: the key table, open addressing, a power of two, at most half full
  entries,         ///< EntryRecord
  programs,        ///< ProgramRecord
  outputs,         ///< OutputRecord, program by program
  absences,        ///< AbsenceRecord
  absent_targets,  ///< AbsentTargetRecord, absence by absence
  blobs,           ///< BlobRecord
};
constexpr std::size_t kSectionCount = static_cast<std::size_t>(Section::blobs) + 1;

struct SectionRecord {
  std::uint64_t offset, size;  ///< bytes
};

struct Header {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t endian_mark;
  std::uint64_t index_hash;  ///< XXH3-64 of the rest of this header and of the index
  std::uint64_t file_size;
  std::uint64_t index_offset;  ///< of the sections, which end the file; the blobs lie before them, after this header
  std::uint32_t section_count;
  std::uint32_t reserved;  ///< 0
  std::array<SectionRecord, kSectionCount> sections;
};
constexpr std::size_t kHashedFrom = offsetof(Header, file_size);

struct StringRecord {
  std::uint32_t offset, size;
};
struct AxisRecord {
  std::uint32_t name, first_value, value_count, default_value;  ///< strings; the default counts from the first value
};
struct TargetRecord {
  std::uint32_t language, version;
};
struct EntryRecord {
  std::uint32_t program, absence;
};
struct ProgramRecord {
  std::uint32_t first_output, output_count, reflection, cost;  ///< the last two are blobs
};
struct OutputRecord {
  std::uint16_t stage, target;
  std::uint32_t blob;
};
struct AbsenceRecord {
  std::uint32_t first, count;
};
struct AbsentTargetRecord {
  std::uint32_t target, reason;  ///< a string
};
struct BlobRecord {
  std::uint64_t offset, size, hash;  ///< XXH3-64
};

static_assert(sizeof(Header) == 48 + 16 * kSectionCount && sizeof(BlobRecord) == 24 && sizeof(OutputRecord) == 8);

constexpr std::uint64_t aligned(std::uint64_t size) {
  return (size + kAlignment - 1) / kAlignment * kAlignment;
}

/// Of two pieces as if they were one.
std::uint64_t hash64(std::string_view first, std::string_view second);

inline std::uint64_t hash64(std::string_view bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

/// Slots of a key table for so many entries.
constexpr std::uint64_t slot_count(std::uint64_t entries) {
  return std::bit_ceil(entries < 1 ? std::uint64_t{2} : 2 * entries);
}

}  // namespace relievo::archive
