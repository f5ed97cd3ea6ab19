#include <algorithm>
#include <map>
#include <mutex>
#include <unordered_map>

#include <fmt/format.h>

#include "files/whole_file.hpp"
#include "permute/archive/contents.hpp"
#include "permute/archive/naming.hpp"
#include "permute/archive/output_order.hpp"
#include "permute/archive/replace.hpp"
#include "relievo/archive.hpp"

namespace relievo {

using archive::Absence;
using archive::CollectedPermutation;
using archive::CollectedProgram;
using archive::ContentHash;

struct ArchiveWriter::State {
  State(std::filesystem::path file, std::vector<ArchiveAxis> axes, archive::Spool opened)
      : path(std::move(file)), spool(std::move(opened)), value_keys(axes) {
    contents.axes = std::move(axes);
  }

  const std::filesystem::path path;
  std::mutex mutex;
  bool finished = false;
  archive::Spool spool;
  archive::ValueKeys value_keys;
  archive::Contents contents;
  std::unordered_map<ContentHash, std::uint32_t, archive::ContentHasher> programs;
  std::map<Absence, std::uint32_t> absences;
  std::unordered_map<std::uint64_t, std::uint32_t> by_key;

  Status open_to_additions() const {
    if (!finished) return {};
    return file_error(path, "archive.write", "is finished; nothing can be added");
  }
  std::uint32_t number_of(const CollectedProgram& program);
  std::uint32_t number_of(Absence absence);
  Status add(std::span<const std::uint16_t> values, const CollectedPermutation& permutation);
  Status check_twin(std::uint32_t twin, std::span<const std::uint16_t> values,
                    const CollectedPermutation& permutation) const;
};

namespace {

Result<Absence> sorted(std::span<const std::pair<Target, std::string>> absent) {
  Absence list;
  for (const auto& [target, reason] : absent) {
    if (!archive::is_target(target))
      return fail(ErrorCode::usage, "archive.values", "an absent target has an unknown language or version");
    list.emplace_back(static_cast<int>(target.language), target.version, reason);
  }
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
  const auto twin = std::ranges::adjacent_find(list, [](const auto& a, const auto& b) {
    return std::get<0>(a) == std::get<0>(b) && std::get<1>(a) == std::get<1>(b);
  });
  if (twin == list.end()) return list;
  const Target target{static_cast<Language>(std::get<0>(*twin)), std::get<1>(*twin)};
  return fail(ErrorCode::usage, "archive.values",
              fmt::format("target {} is absent for two reasons: {}; {}", to_string(target), std::get<2>(*twin),
                          std::get<2>(*std::next(twin))));
}

std::vector<ContentHash> hashes_of(const ProgramImage& program) {
  std::vector<ContentHash> hashes;
  for (const ProgramOutput& output : program.outputs) hashes.push_back(archive::content_hash(output.bytes));
  hashes.push_back(archive::content_hash(program.reflection));
  hashes.push_back(archive::content_hash(program.cost));
  return hashes;
}

Result<CollectedProgram> spool_program(archive::Spool& spool, const ProgramImage& program,
                                       std::span<const ContentHash> hashes) {
  CollectedProgram collected;
  std::size_t next = 0;
  for (const ProgramOutput& output : program.outputs) {
    const Result<std::uint32_t> blob = spool.add(output.bytes, hashes[next++]);
    if (!blob) return tl::unexpected(blob.error());
    collected.outputs.push_back({output.stage, output.target, *blob});
  }
  const Result<std::uint32_t> reflection = spool.add(program.reflection, hashes[next++]);
  if (!reflection) return tl::unexpected(reflection.error());
  const Result<std::uint32_t> cost = spool.add(program.cost, hashes[next]);
  if (!cost) return tl::unexpected(cost.error());
  collected.reflection = *reflection;
  collected.cost = *cost;
  return collected;
}

}  // namespace

/// Of an equal program, where there is one.
std::uint32_t ArchiveWriter::State::number_of(const CollectedProgram& program) {
  std::vector<std::uint32_t> words = {program.reflection, program.cost};
  for (const archive::ProgramOutputBlob& output : program.outputs) {
    words.insert(words.end(),
                 {static_cast<std::uint32_t>(output.stage), static_cast<std::uint32_t>(output.target.language),
                  static_cast<std::uint32_t>(output.target.version), output.blob});
  }
  const std::string_view bytes(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t));
  const auto [known, is_new] =
      programs.try_emplace(archive::content_hash(bytes), static_cast<std::uint32_t>(contents.programs.size()));
  if (is_new) contents.programs.push_back(program);
  return known->second;
}

std::uint32_t ArchiveWriter::State::number_of(Absence absence) {
  if (absence.empty()) return archive::kNone;
  const auto [known, is_new] =
      absences.try_emplace(std::move(absence), static_cast<std::uint32_t>(contents.absences.size()));
  if (is_new) contents.absences.push_back(&known->first);
  return known->second;
}

Status ArchiveWriter::State::add(std::span<const std::uint16_t> values, const CollectedPermutation& permutation) {
  const auto [twin, is_new] =
      by_key.try_emplace(permutation.key, static_cast<std::uint32_t>(contents.permutations.size()));
  if (!is_new) return check_twin(twin->second, values, permutation);
  contents.permutations.push_back(permutation);
  contents.values.insert(contents.values.end(), values.begin(), values.end());
  return {};
}

/// The same permutation may come twice; another one with its key may not.
Status ArchiveWriter::State::check_twin(std::uint32_t twin, std::span<const std::uint16_t> values,
                                        const CollectedPermutation& permutation) const {
  const std::string name = archive::full_name_of(contents.axes, values);
  if (!std::ranges::equal(contents.values_of(twin), values)) {
    return fail(ErrorCode::usage, "archive.key-collision",
                fmt::format("permutations '{}' and '{}' have one key, {:016x}",
                            archive::full_name_of(contents.axes, contents.values_of(twin)), name, permutation.key),
                path.string());
  }
  const CollectedPermutation& known = contents.permutations[twin];
  if (known.program == permutation.program && known.absence == permutation.absence) return {};
  const std::string_view difference = known.program != permutation.program ? "programs" : "lists of absent targets";
  return fail(ErrorCode::usage, "archive.conflict", fmt::format("permutation '{}' has two {}", name, difference),
              path.string());
}

ArchiveWriter::ArchiveWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
ArchiveWriter::ArchiveWriter(ArchiveWriter&&) noexcept = default;
ArchiveWriter& ArchiveWriter::operator=(ArchiveWriter&&) noexcept = default;
ArchiveWriter::~ArchiveWriter() = default;

Result<ArchiveWriter> ArchiveWriter::create(const std::filesystem::path& path, std::vector<ArchiveAxis> axes) {
  if (const std::string fault = archive::fault_of(std::span<const ArchiveAxis>(axes)); !fault.empty())
    return fail(ErrorCode::usage, "archive.axes", fault, path.string());
  if (Status status = archive::check_replaceable(path); !status) return tl::unexpected(status.error());
  const std::filesystem::path target = files::link_target(path);
  files::sweep_beside(target);
  Result<archive::Spool> spool = archive::Spool::create(target);
  if (!spool) return tl::unexpected(spool.error());
  return ArchiveWriter(std::make_unique<State>(target, std::move(axes), std::move(*spool)));
}

Result<std::uint32_t> ArchiveWriter::add_program(const ProgramImage& program) {
  if (!archive::in_order(program.outputs)) {
    return fail(ErrorCode::usage, "archive.program",
                "the outputs of a program are not by stage and target, each once; expected known ones in order",
                state_->path.string());
  }
  const std::vector<ContentHash> hashes = hashes_of(program);
  const std::lock_guard lock(state_->mutex);
  if (Status status = state_->open_to_additions(); !status) return tl::unexpected(status.error());
  const Result<CollectedProgram> collected = spool_program(state_->spool, program, hashes);
  if (!collected) return tl::unexpected(collected.error());
  return state_->number_of(*collected);
}

Status ArchiveWriter::add_permutation(std::span<const std::uint16_t> values, std::uint32_t program,
                                      std::span<const std::pair<Target, std::string>> absent) {
  const archive::Contents& contents = state_->contents;
  if (!archive::in_range(contents.axes, values)) {
    return fail(ErrorCode::usage, "archive.values",
                fmt::format("a permutation has {} values, [{}]; expected one in range for each of {} axes",
                            values.size(), fmt::join(values, ", "), contents.axes.size()),
                state_->path.string());
  }
  Result<Absence> absence = sorted(absent);
  if (!absence) return tl::unexpected(absence.error());
  const std::lock_guard lock(state_->mutex);
  if (Status status = state_->open_to_additions(); !status) return status;
  if (program >= contents.programs.size()) {
    return fail(ErrorCode::usage, "archive.values",
                fmt::format("program {} was not added; there are {}", program, contents.programs.size()),
                state_->path.string());
  }
  for (const archive::ProgramOutputBlob& output : contents.programs[program].outputs) {
    const auto is_absent = [&](const auto& a) {
      return std::get<0>(a) == static_cast<int>(output.target.language) && std::get<1>(a) == output.target.version;
    };
    if (std::ranges::any_of(*absence, is_absent)) {
      return fail(ErrorCode::usage, "archive.values",
                  fmt::format("target {} is absent and has an output", to_string(output.target)),
                  state_->path.string());
    }
  }
  const std::uint32_t number = state_->number_of(std::move(*absence));
  return state_->add(values, {program, number, state_->value_keys.key(values)});
}

Status ArchiveWriter::finish() {
  const std::lock_guard lock(state_->mutex);
  if (Status status = state_->open_to_additions(); !status) return status;
  const Result<archive::Layout> layout = archive::lay_out(state_->contents, state_->spool.blobs());
  if (!layout) return tl::unexpected(layout.error());
  Status status = archive::replace(state_->path, *layout, state_->spool);
  state_->finished = status.has_value();
  return status;
}

}  // namespace relievo
