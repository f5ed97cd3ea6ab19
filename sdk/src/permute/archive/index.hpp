/// The index of an archive as it lies in memory, and the checks that make it safe to use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "permute/archive/format.hpp"
#include "relievo/archive.hpp"

namespace relievo::archive {

/// Views into the mapped file; what is not a view was decoded while it was checked.
struct Index {
  std::span<const std::byte> file;
  std::uint64_t blobs_end = 0;  ///< where the index begins
  std::string_view text;
  std::span<const StringRecord> strings;
  std::span<const AxisRecord> axis_records;
  std::span<const TargetRecord> target_records;
  std::span<const std::uint16_t> values;
  std::span<const std::uint64_t> keys;
  std::span<const std::uint32_t> slots;
  std::span<const EntryRecord> entries;
  std::span<const ProgramRecord> programs;
  std::span<const OutputRecord> outputs;
  std::span<const AbsenceRecord> absences;
  std::span<const AbsentTargetRecord> absent_targets;
  std::span<const BlobRecord> blobs;

  std::vector<ArchiveAxis> axes;
  std::vector<Target> targets;

  std::string_view string(std::uint32_t index) const { return text.substr(strings[index].offset, strings[index].size); }
  std::span<const std::uint16_t> values_of(std::uint32_t entry) const {
    return values.subspan(std::size_t{entry} * axes.size(), axes.size());
  }
  std::span<const OutputRecord> outputs_of(const ProgramRecord& program) const {
    return outputs.subspan(program.first_output, program.output_count);
  }
  std::string_view bytes_of(const BlobRecord& blob) const {
    return {reinterpret_cast<const char*>(file.data()) + blob.offset, static_cast<std::size_t>(blob.size)};
  }
};

/// Checks the header and the whole index, as strictly as the writer writes: what passes can be used without further
/// checks; only the blobs' bytes are still unread. `name` is for messages. Errors: "archive.format", "archive.version".
Result<Index> read_index(std::span<const std::byte> file, const std::string& name);

/// What is wrong with the records behind the header, or empty. Decodes axes and targets.
std::string fault_of_axes(Index& index);
std::string fault_of_targets(Index& index);
std::string fault_of_entries(const Index& index);
std::string fault_of_keys(const Index& index);
std::string fault_of_programs(const Index& index);
std::string fault_of_absences(const Index& index);
std::string fault_of_blobs(const Index& index);

}  // namespace relievo::archive
