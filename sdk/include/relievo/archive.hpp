/// One file with the programs of many permutations for many targets, to be mapped into memory.
/// Every free function here is thread-safe, as is every const function of an Archive.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "relievo/compile.hpp"

namespace relievo {

/// The source of one shader for one target: text, or SPIR-V words in little-endian bytes.
struct ProgramOutput {
  ShaderStage stage = ShaderStage::compute;
  Target target;
  std::string bytes;
  friend bool operator==(const ProgramOutput&, const ProgramOutput&) = default;
};

/// What a permutation became: what caches keep and archives pack. Equal inputs give equal bytes.
struct ProgramImage {
  std::vector<ProgramOutput> outputs;  ///< by shader stage, then target, each once
  std::string reflection;              ///< JSON, docs/reflection.md
  std::string cost;                    ///< JSON: instructions, fetch bound, loop bounds a shader; docs/permutations.md
  friend bool operator==(const ProgramImage&, const ProgramImage&) = default;
};

/// A self-checking byte form. `read_program` accepts what `write_program` wrote with this version, nothing else.
std::string write_program(const ProgramImage& program);
/// Errors: "archive.program" for anything damaged, or of another version.
Result<ProgramImage> read_program(std::string_view bytes);

/// The share that one axis has in a permutation's 64-bit key; a permutation's key is the sum over the axes that are not
/// at their default. So an axis that is added later, with a default, changes no existing key.
/// FNV-1a over "axis=value", then the finalizer of SplitMix64 (Steele, Lea and Flood 2014). Never 0.
constexpr std::uint64_t axis_key(std::string_view axis, std::string_view value) {
  std::uint64_t hash = 14695981039346656037ull;
  const auto add = [&hash](char c) { hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull; };
  for (const char c : axis) add(c);
  add('=');
  for (const char c : value) add(c);
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ull;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebull;
  hash ^= hash >> 31;
  return hash == 0 ? 1 : hash;
}

/// An axis of an archive: names as in the manifest.
struct ArchiveAxis {
  std::string name;
  std::vector<std::string> values;  ///< at most 65534
  std::uint16_t default_value = 0;  ///< index into `values`
  friend bool operator==(const ArchiveAxis&, const ArchiveAxis&) = default;
};

/// In place of a value's index: the permutation does not have this axis. Adds nothing to its key.
constexpr std::uint16_t kNoValue = 0xffff;

/// Writes an archive. The file's bytes depend on the axes and on which permutation has which program, not on the order
/// in which they were added; equal outputs lie in it once. Programs go to a spool file beside `path` while they are
/// added, so memory does not grow with their size; `path` itself appears, whole, when `finish` succeeds.
/// Thread-safe: `create`, `add_program` and `add_permutation`; `finish` and moves are for when no other thread uses it.
class ArchiveWriter {
 public:
  /// Errors: "archive.write" when the folder cannot be written; "archive.axes" for two axes or values of one name, an
  /// axis whose name is empty or has an '=', no or too many values, or a default that is none of them.
  static Result<ArchiveWriter> create(const std::filesystem::path& path, std::vector<ArchiveAxis> axes);
  ArchiveWriter(ArchiveWriter&&) noexcept;
  ArchiveWriter& operator=(ArchiveWriter&&) noexcept;
  ~ArchiveWriter();  ///< unfinished: removes the spool file, and leaves `path` as it was

  /// Keeps a program's outputs; the number stands for it in `add_permutation`, and is that of an equal program which
  /// was added before. Errors: "archive.program" for outputs that are not in order, "archive.write".
  Result<std::uint32_t> add_program(const ProgramImage& program);
  /// `values`: an index (or kNoValue) an axis. `absent`: targets that it was asked for and cannot have, each with the
  /// reason. The same permutation may come again. Errors: "archive.values" for a wrong count or index, a program that
  /// was not added, or a target with two reasons or with outputs of the program; "archive.conflict" when the
  /// permutation comes again with another program or other absent targets; "archive.key-collision" when two
  /// permutations have one key: the message names both.
  Status add_permutation(std::span<const std::uint16_t> values, std::uint32_t program,
                         std::span<const std::pair<Target, std::string>> absent = {});
  /// Writes the archive and renames it to `path`; nothing can be added after it. Errors: "archive.write".
  Status finish();

 private:
  struct State;
  explicit ArchiveWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// What an archive has of a program, without its bytes.
struct ArchiveOutput {
  ShaderStage stage = ShaderStage::compute;
  Target target;
  std::uint64_t size = 0;  ///< bytes
  friend bool operator==(const ArchiveOutput&, const ArchiveOutput&) = default;
};

/// An archive that is mapped into memory. Opening and every const function is thread-safe; moving and destroying are
/// not. Views live as long as the archive. The file must not be changed while it is mapped; writers here replace files
/// and never change them.
class Archive {
 public:
  /// Maps the file, and checks its header and index whole: whatever passes can be used without a crash.
  /// Errors: "archive.open" when it cannot be read; "archive.format" when it is no archive, or truncated or damaged;
  /// "archive.version", naming both versions.
  static Result<Archive> open(const std::filesystem::path& path);
  /// The same of bytes in memory, which must outlive the archive and be aligned to 8.
  static Result<Archive> from_memory(std::span<const std::byte> bytes);
  Archive(Archive&&) noexcept;
  Archive& operator=(Archive&&) noexcept;
  ~Archive();

  /// A permutation in the archive, below `size()`; they are sorted by their values. Of any other number what follows
  /// is empty, or the error "archive.entry".
  using Entry = std::uint32_t;

  std::size_t size() const;           ///< permutations
  std::size_t program_count() const;  ///< different programs
  const std::vector<ArchiveAxis>& axes() const;
  const std::vector<Target>& targets() const;  ///< in order; of every output, and absent ones

  /// The key of an assignment; axes that are left out are at their default. Allocates nothing. An axis or value that
  /// the archive does not know adds its `axis_key`, so that it is found missing.
  std::uint64_t key(std::span<const std::pair<std::string_view, std::string_view>> assignment) const;
  /// O(1), allocates nothing.
  std::optional<Entry> find(std::uint64_t key) const;
  /// As `key` and `find`. Errors: "archive.missing", whose message gives the nearest permutations of the archive (at
  /// most 3) and the axes in which they differ.
  Result<Entry> find(std::span<const std::pair<std::string_view, std::string_view>> assignment) const;

  std::uint64_t key(Entry entry) const;
  std::span<const std::uint16_t> values(Entry entry) const;  ///< one an axis
  std::string name(Entry entry) const;                       ///< "technique=relief address=clamp": what is not default
  std::uint32_t program(Entry entry) const;                  ///< equal for permutations that share one

  /// One shader for one target; checked against its hash at every call. Errors: "archive.no-output" with the shaders
  /// and targets that there are, or with the reason why this target has none; "archive.damaged".
  Result<std::string_view> output(Entry entry, ShaderStage stage, const Target& target) const;
  std::vector<ShaderStage> stages(Entry entry) const;
  std::vector<ArchiveOutput> outputs(Entry entry) const;  ///< what `output` can give
  /// The targets that the permutation was asked for and cannot have, each with the reason.
  std::vector<std::pair<Target, std::string_view>> absent(Entry entry) const;
  Result<std::string_view> reflection(Entry entry) const;
  Result<std::string_view> cost(Entry entry) const;
  /// The whole program, checked.
  Result<ProgramImage> load(Entry entry) const;

  /// Reads and checks every byte. Errors: "archive.damaged".
  Status verify() const;

 private:
  struct State;
  explicit Archive(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// One archive with the permutations of all; the same bytes as if one writer had had them all. The axes must agree.
/// A permutation may be in several of them when its program is the same. Errors: "archive.axes", "archive.conflict",
/// "archive.no-parts", and those of opening and writing.
Status merge_archives(std::span<const std::filesystem::path> parts, const std::filesystem::path& path);

}  // namespace relievo
