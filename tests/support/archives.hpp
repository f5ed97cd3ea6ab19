/// Small archives for tests, and what must come out of them again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "relievo/archive.hpp"
#include "support/files.hpp"

namespace relievo::test {

constexpr Target kSpirv{Language::spirv, 10}, kGlsl{Language::glsl, 450}, kMsl{Language::msl, 22};

struct SamplePermutation {
  std::vector<std::uint16_t> values;
  ProgramImage program;
  std::vector<std::pair<Target, std::string>> absent;
};

struct SampleArchive {
  std::vector<ArchiveAxis> axes;
  std::vector<SamplePermutation> permutations;
};

inline std::vector<ArchiveAxis> sample_axes() {
  return {{"technique", {"bump", "relief", "cone"}, 0}, {"address", {"repeat", "clamp"}, 0}, {"steps", {"8", "16"}, 1}};
}

/// Vertex shaders are common to all, as in a real project.
inline ProgramImage sample_program(const std::string& name, std::size_t size = 40) {
  ProgramImage program;
  std::string words(size + size % 4, '\x03');
  std::memcpy(words.data(), name.data(), std::min(name.size(), words.size()));
  program.outputs = {{ShaderStage::vertex, kSpirv, "the same words!!"},
                     {ShaderStage::vertex, kGlsl, "void main() { gl_Position = vec4(0); }\n"},
                     {ShaderStage::fragment, kSpirv, words},
                     {ShaderStage::fragment, kGlsl, "// " + name + "\n" + std::string(size, ' ') + "void main() {}\n"}};
  program.reflection = "{\"schema\": 1, \"name\": \"" + name + "\"}";
  program.cost = "{\"instructions\": " + std::to_string(name.size()) + "}";
  return program;
}

/// Eight permutations of five programs: relief and cone with both addresses; bump has no steps.
inline SampleArchive sample_archive(std::size_t size = 40) {
  SampleArchive sample{sample_axes(), {}};
  const auto add = [&](std::vector<std::uint16_t> values, const std::string& name, bool has_msl) {
    SamplePermutation permutation{std::move(values), sample_program(name, size), {}};
    if (has_msl) permutation.program.outputs.push_back({ShaderStage::fragment, kMsl, "fragment void " + name + "();"});
    if (!has_msl) permutation.absent = {{kMsl, "geometry shaders are not in MSL; use prism_pulled"}};
    sample.permutations.push_back(std::move(permutation));
  };
  add({0, 0, kNoValue}, "bump", true);
  add({0, 1, kNoValue}, "bump", true);
  for (const std::uint16_t address : {0, 1}) {
    add({1, address, 0}, "relief8", false);
    add({1, address, 1}, "relief16", false);
    add({2, address, 1}, address == 0 ? "cone_repeat" : "cone_clamp", true);
  }
  return sample;
}

template <class T>
T expect_value(Result<T> result) {
  if (!result) throw std::runtime_error(format(result.error()));
  return std::move(*result);
}
inline void expect_value(Status status) {
  if (!status) throw std::runtime_error(format(status.error()));
}

inline void add_to(ArchiveWriter& writer, const SamplePermutation& permutation) {
  const std::uint32_t program = expect_value(writer.add_program(permutation.program));
  expect_value(writer.add_permutation(permutation.values, program, permutation.absent));
}

inline void write_archive(const std::filesystem::path& path, const SampleArchive& sample) {
  ArchiveWriter writer = expect_value(ArchiveWriter::create(path, sample.axes));
  for (const SamplePermutation& permutation : sample.permutations) add_to(writer, permutation);
  expect_value(writer.finish());
}

inline std::string archive_bytes(const SampleArchive& sample) {
  const TemporaryFolder folder;
  write_archive(folder / "a.rva", sample);
  return TemporaryFolder::read(folder / "a.rva");
}

/// What tests/fuzz/corpus holds of these formats, by its path there.
inline std::map<std::string, std::string> stored_inputs() {
  return {{"archive/sample.rva", archive_bytes(sample_archive())},
          {"archive/empty.rva", archive_bytes({sample_axes(), {}})},
          {"archive/no_axes.rva", archive_bytes({{}, {{{}, ProgramImage{}, {{kMsl, "no"}}}}})},
          {"program/sample.rvp", write_program(sample_program("stored"))},
          {"program/empty.rvp", write_program({})}};
}

/// Bytes at an address that is a multiple of 8.
class AlignedBytes {
 public:
  explicit AlignedBytes(std::string_view bytes) : words_(bytes.size() / 8 + 1), size_(bytes.size()) {
    if (!bytes.empty()) std::memcpy(words_.data(), bytes.data(), bytes.size());
  }
  std::span<const std::byte> span() const { return std::as_bytes(std::span(words_)).first(size_); }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t size_;
};

/// What an archive gives that it was not given, or empty. Errors are no fault unless `whole`.
inline std::string fault_of(const Archive& archive, const SampleArchive& sample, bool whole) {
  if (archive.size() != sample.permutations.size()) return "another number of permutations";
  if (archive.axes() != sample.axes) return "other axes";
  std::map<std::vector<std::uint16_t>, Archive::Entry> entries;
  for (Archive::Entry entry = 0; entry < archive.size(); ++entry) {
    const auto values = archive.values(entry);
    entries[{values.begin(), values.end()}] = entry;
    if (archive.find(archive.key(entry)) != entry) return "a key that does not find its permutation";
  }
  for (const SamplePermutation& expected : sample.permutations) {
    const auto found = entries.find(expected.values);
    if (found == entries.end()) return "a permutation is lost";
    const Archive::Entry entry = found->second;
    std::size_t absent = 0;
    for (const auto& [target, reason] : archive.absent(entry))
      absent += std::ranges::count(expected.absent, std::pair(target, std::string(reason)));
    if (absent != expected.absent.size() || archive.absent(entry).size() != absent) return "other absent targets";
    for (const auto& [target, reason] : expected.absent) {
      for (const ShaderStage stage : archive.stages(entry)) {
        const auto output = archive.output(entry, stage, target);
        if (output) return "an absent target has an output";
        if (output.error().message.find(reason) == std::string::npos) return "the reason of an absence is not told";
      }
    }
    if (archive.outputs(entry).size() != expected.program.outputs.size()) return "another number of outputs";
    for (const ProgramOutput& output : expected.program.outputs) {
      const auto bytes = archive.output(entry, output.stage, output.target);
      if (whole && !bytes) return bytes.error().message;
      if (bytes && *bytes != output.bytes) return "a wrong shader";
    }
    const auto program = archive.load(entry);
    if (whole && !program) return program.error().message;
    if (program && *program != expected.program) return "a wrong program";
    if (const auto text = archive.reflection(entry); text && *text != expected.program.reflection)
      return "a wrong reflection";
    if (const auto text = archive.cost(entry); text && *text != expected.program.cost) return "a wrong cost";
  }
  return {};
}

/// As `fault_of` of bytes that may be damaged: refusing them is right.
inline std::string fault_of(std::string_view bytes, const SampleArchive& sample, bool whole = false) {
  const AlignedBytes aligned(bytes);
  const auto archive = Archive::from_memory(aligned.span());
  if (!archive) return whole ? archive.error().message : std::string();
  return fault_of(*archive, sample, whole);
}

}  // namespace relievo::test
