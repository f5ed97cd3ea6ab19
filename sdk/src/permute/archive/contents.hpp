/// What a writer has collected, numbered in the order of adding, and the one order in which it is written.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "permute/archive/format.hpp"
#include "permute/archive/spool.hpp"
#include "relievo/archive.hpp"

namespace relievo::archive {

struct ProgramOutputBlob {
  ShaderStage stage = ShaderStage::compute;
  Target target;
  std::uint32_t blob = 0;
};

struct CollectedProgram {
  std::vector<ProgramOutputBlob> outputs;
  std::uint32_t reflection = 0, cost = 0;  ///< blobs
};

/// Language, version and reason of each absent target, sorted.
using Absence = std::vector<std::tuple<int, int, std::string>>;

struct CollectedPermutation {
  std::uint32_t program = 0, absence = kNone;
  std::uint64_t key = 0;
};

struct Contents {
  std::vector<ArchiveAxis> axes;
  std::vector<CollectedProgram> programs;
  std::vector<const Absence*> absences;
  std::vector<CollectedPermutation> permutations;
  std::vector<std::uint16_t> values;  ///< one an axis and permutation

  std::span<const std::uint16_t> values_of(std::size_t permutation) const {
    return std::span(values).subspan(permutation * axes.size(), axes.size());
  }
};

/// The bytes before and after the blobs, and which blobs of the spool lie between in what order.
struct Layout {
  std::string header, index;
  std::uint64_t index_offset = 0;
  std::vector<std::uint32_t> blobs;
  bool is_spool = false;  ///< the spool has exactly these blobs, where an archive has them
};

/// Depends on which permutation has which program alone, not on how things are numbered in `contents`.
/// Errors: "archive.write" when a table has more than 2³² − 1 records.
Result<Layout> lay_out(const Contents& contents, std::span<const SpooledBlob> blobs);

}  // namespace relievo::archive
