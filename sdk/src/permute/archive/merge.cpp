#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "relievo/archive.hpp"

namespace relievo {

namespace {

std::string difference(std::span<const ArchiveAxis> expected, std::span<const ArchiveAxis> given) {
  if (expected.size() != given.size())
    return fmt::format("it has {} axes; the first has {}", given.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (given[i].name != expected[i].name)
      return fmt::format("axis {} is '{}'; that of the first is '{}'", i, given[i].name, expected[i].name);
    if (given[i].values != expected[i].values)
      return fmt::format("axis '{}' has the values {}; that of the first has {}", given[i].name,
                         fmt::join(given[i].values, ", "), fmt::join(expected[i].values, ", "));
    if (given[i].default_value != expected[i].default_value)
      return fmt::format("axis '{}' has another default than that of the first", given[i].name);
  }
  return {};
}

Result<std::vector<Archive>> open_parts(std::span<const std::filesystem::path> paths) {
  std::vector<Archive> parts;
  for (const std::filesystem::path& path : paths) {
    Result<Archive> part = Archive::open(path);
    if (!part) return tl::unexpected(part.error());
    parts.push_back(std::move(*part));
    const std::string difference_to_first = difference(parts.front().axes(), parts.back().axes());
    if (difference_to_first.empty()) continue;
    return fail(ErrorCode::usage, "archive.axes",
                fmt::format("'{}' has other axes: {}", path.filename().string(), difference_to_first), path.string());
  }
  return parts;
}

/// Reads each program once, when its first permutation comes.
Status add_part(ArchiveWriter& writer, const Archive& part, const std::filesystem::path& path) {
  std::vector<std::optional<std::uint32_t>> programs(part.program_count());
  for (Archive::Entry entry = 0; entry < part.size(); ++entry) {
    std::optional<std::uint32_t>& program = programs[part.program(entry)];
    if (!program) {
      const Result<ProgramImage> image = part.load(entry);
      if (!image) return tl::unexpected(image.error());
      const Result<std::uint32_t> number = writer.add_program(*image);
      if (!number) return tl::unexpected(number.error());
      program = *number;
    }
    std::vector<std::pair<Target, std::string>> absent;
    for (const auto& [target, reason] : part.absent(entry)) absent.emplace_back(target, reason);
    Status status = writer.add_permutation(part.values(entry), *program, absent);
    if (status) continue;
    status.error().message =
        fmt::format("{}, in '{}' and a part before it", status.error().message, path.filename().string());
    return status;
  }
  return {};
}

}  // namespace

Status merge_archives(std::span<const std::filesystem::path> paths, const std::filesystem::path& path) {
  if (paths.empty())
    return fail(ErrorCode::usage, "archive.no-parts", "no archives are given; expected at least one", path.string());
  Result<std::vector<Archive>> parts = open_parts(paths);
  if (!parts) return tl::unexpected(parts.error());
  Result<ArchiveWriter> writer = ArchiveWriter::create(path, parts->front().axes());
  if (!writer) return tl::unexpected(writer.error());
  for (std::size_t i = 0; i < parts->size(); ++i) {
    if (Status status = add_part(*writer, (*parts)[i], paths[i]); !status) return status;
  }
  return writer->finish();
}

}  // namespace relievo
