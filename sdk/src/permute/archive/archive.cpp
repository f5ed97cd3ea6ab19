#include "relievo/archive.hpp"

#include <fmt/format.h>

#include "files/whole_file.hpp"
#include "permute/archive/index.hpp"
#include "permute/archive/mapping.hpp"
#include "permute/archive/missing.hpp"
#include "permute/archive/naming.hpp"

namespace relievo {

using archive::BlobRecord;
using archive::Index;
using archive::OutputRecord;
using archive::ProgramRecord;

struct Archive::State {
  archive::Mapping mapping;
  Index index;
  std::string name;  ///< of the file, for messages

  bool has(Entry entry) const { return entry < index.entries.size(); }
  const ProgramRecord& program(Entry entry) const { return index.programs[index.entries[entry].program]; }
  tl::unexpected<Error> no_entry(Entry entry) const {
    return fail(ErrorCode::usage, "archive.entry",
                fmt::format("there is no permutation {}; the archive has {}", entry, index.entries.size()), name);
  }
  Result<std::string_view> checked(std::uint32_t blob, std::string_view what) const {
    const BlobRecord& record = index.blobs[blob];
    const std::string_view bytes = index.bytes_of(record);
    if (archive::hash64(bytes) == record.hash) return bytes;
    return fail(ErrorCode::io, "archive.damaged",
                fmt::format("the archive is damaged: the hash of {} (blob {}) differs", what, blob), name);
  }
};

Archive::Archive(std::unique_ptr<State> state) : state_(std::move(state)) {}
Archive::Archive(Archive&&) noexcept = default;
Archive& Archive::operator=(Archive&&) noexcept = default;
Archive::~Archive() = default;

Result<Archive> Archive::open(const std::filesystem::path& path) {
  Result<archive::Mapping> mapping = archive::Mapping::of_file(path);
  if (!mapping) return tl::unexpected(mapping.error());
  Result<Index> index = archive::read_index(mapping->bytes(), path.string());
  if (!index) return tl::unexpected(index.error());
  return Archive(std::make_unique<State>(State{std::move(*mapping), std::move(*index), path.string()}));
}

Result<Archive> Archive::from_memory(std::span<const std::byte> bytes) {
  Result<Index> index = archive::read_index(bytes, "");
  if (!index) return tl::unexpected(index.error());
  return Archive(std::make_unique<State>(State{archive::Mapping(bytes), std::move(*index), ""}));
}

std::size_t Archive::size() const {
  return state_->index.entries.size();
}
std::size_t Archive::program_count() const {
  return state_->index.programs.size();
}
const std::vector<ArchiveAxis>& Archive::axes() const {
  return state_->index.axes;
}
const std::vector<Target>& Archive::targets() const {
  return state_->index.targets;
}

std::uint64_t Archive::key(std::span<const std::pair<std::string_view, std::string_view>> assignment) const {
  std::uint64_t key = 0;
  for (const auto& [name, value] : assignment) {
    bool is_default = false;
    for (const ArchiveAxis& axis : state_->index.axes)
      is_default |= axis.name == name && axis.values[axis.default_value] == value;
    if (!is_default) key += axis_key(name, value);
  }
  return key;
}

std::optional<Archive::Entry> Archive::find(std::uint64_t key) const {
  const Index& index = state_->index;
  const std::uint64_t mask = index.slots.size() - 1;
  for (std::uint64_t slot = key & mask;; slot = (slot + 1) & mask) {
    const std::uint32_t entry = index.slots[slot];
    if (entry == archive::kNone) return std::nullopt;
    if (index.keys[entry] == key) return entry;
  }
}

Result<Archive::Entry> Archive::find(std::span<const std::pair<std::string_view, std::string_view>> assignment) const {
  if (const std::optional<Entry> entry = find(key(assignment))) return *entry;
  return fail(ErrorCode::usage, "archive.missing", archive::explain_missing(state_->index, assignment), state_->name);
}

std::uint64_t Archive::key(Entry entry) const {
  return state_->has(entry) ? state_->index.keys[entry] : 0;
}
std::span<const std::uint16_t> Archive::values(Entry entry) const {
  return state_->has(entry) ? state_->index.values_of(entry) : std::span<const std::uint16_t>();
}
std::string Archive::name(Entry entry) const {
  return state_->has(entry) ? archive::name_of(axes(), values(entry)) : std::string();
}
std::uint32_t Archive::program(Entry entry) const {
  return state_->has(entry) ? state_->index.entries[entry].program : archive::kNone;
}

Result<std::string_view> Archive::output(Entry entry, ShaderStage stage, const Target& target) const {
  if (!state_->has(entry)) return state_->no_entry(entry);
  const Index& index = state_->index;
  for (const OutputRecord& output : index.outputs_of(state_->program(entry))) {
    if (static_cast<ShaderStage>(output.stage) == stage && index.targets[output.target] == target)
      return state_->checked(output.blob, "a shader");
  }
  Error error = archive::explain_no_output(index, entry, stage, target);
  error.file = state_->name;
  return tl::unexpected(std::move(error));
}

std::vector<ArchiveOutput> Archive::outputs(Entry entry) const {
  std::vector<ArchiveOutput> list;
  if (!state_->has(entry)) return list;
  const Index& index = state_->index;
  for (const OutputRecord& output : index.outputs_of(state_->program(entry)))
    list.push_back(
        {static_cast<ShaderStage>(output.stage), index.targets[output.target], index.blobs[output.blob].size});
  return list;
}

std::vector<ShaderStage> Archive::stages(Entry entry) const {
  std::vector<ShaderStage> stages;
  for (const ArchiveOutput& output : outputs(entry)) {
    if (stages.empty() || stages.back() != output.stage) stages.push_back(output.stage);
  }
  return stages;
}

std::vector<std::pair<Target, std::string_view>> Archive::absent(Entry entry) const {
  return state_->has(entry) ? archive::absent_targets(state_->index, entry)
                            : std::vector<std::pair<Target, std::string_view>>();
}

Result<std::string_view> Archive::reflection(Entry entry) const {
  if (!state_->has(entry)) return state_->no_entry(entry);
  return state_->checked(state_->program(entry).reflection, "the reflection");
}

Result<std::string_view> Archive::cost(Entry entry) const {
  if (!state_->has(entry)) return state_->no_entry(entry);
  return state_->checked(state_->program(entry).cost, "the cost");
}

Result<ProgramImage> Archive::load(Entry entry) const {
  const Result<std::string_view> program_reflection = reflection(entry);
  if (!program_reflection) return tl::unexpected(program_reflection.error());
  const Result<std::string_view> program_cost = cost(entry);
  if (!program_cost) return tl::unexpected(program_cost.error());
  ProgramImage program{{}, std::string(*program_reflection), std::string(*program_cost)};
  for (const ArchiveOutput& each : outputs(entry)) {
    const Result<std::string_view> bytes = output(entry, each.stage, each.target);
    if (!bytes) return tl::unexpected(bytes.error());
    program.outputs.push_back({each.stage, each.target, std::string(*bytes)});
  }
  return program;
}

Status Archive::verify() const {
  const Index& index = state_->index;
  const auto* file = reinterpret_cast<const char*>(index.file.data());
  for (std::uint32_t blob = 0; blob < index.blobs.size(); ++blob) {
    if (const auto bytes = state_->checked(blob, "a part of it"); !bytes) return tl::unexpected(bytes.error());
    const std::uint64_t end = index.blobs[blob].offset + index.blobs[blob].size;
    for (std::uint64_t at = end; at < archive::aligned(end); ++at) {
      if (file[at] != 0)
        return fail(ErrorCode::io, "archive.damaged", fmt::format("the archive is damaged: byte {} is not 0", at),
                    state_->name);
    }
  }
  return {};
}

}  // namespace relievo
