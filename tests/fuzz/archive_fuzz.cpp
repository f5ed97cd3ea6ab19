/// Any bytes as an archive: refused, or usable through every accessor without contradiction.
#include "fuzz/check.hpp"
#include "support/archive_walk.hpp"
#include "support/archives.hpp"
#include "support/damage.hpp"

namespace {

void try_archive(std::string_view bytes) {
  const relievo::test::AlignedBytes aligned(bytes);
  const auto archive = relievo::Archive::from_memory(aligned.span());
  if (archive) return relievo::fuzz::expect_none(relievo::test::contradiction_of(*archive));
  if (archive.error().message.empty() || !archive.error().id.starts_with("archive."))
    relievo::fuzz::expect_none("the error says nothing");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  try_archive(bytes);
  // Sizes and hash made right, which no mutation hits: the checks behind them are reached.
  if (bytes.size() < 48) return 0;
  const std::uint64_t file_size = bytes.size();
  std::memcpy(bytes.data() + 24, &file_size, sizeof file_size);
  relievo::test::mend_index_hash(bytes);
  try_archive(bytes);
  return 0;
}
