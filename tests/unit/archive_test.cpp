#include "relievo/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

#include "support/archives.hpp"

namespace relievo {
namespace {

using test::archive_bytes;
using test::fault_of;
using test::kGlsl;
using test::kMsl;
using test::kSpirv;
using test::sample_archive;
using test::sample_axes;
using test::sample_program;
using test::SampleArchive;
using test::TemporaryFolder;
using test::write_archive;
using testing::HasSubstr;

using Pair = std::pair<std::string_view, std::string_view>;

std::string id_of(const Status& status) {
  return status ? "" : status.error().id;
}
template <class T>
std::string id_of(const Result<T>& result) {
  return result ? "" : result.error().id;
}

/// The sample written and opened, for tests that ask it something.
class OpenedArchive {
 public:
  explicit OpenedArchive(const SampleArchive& sample = sample_archive()) {
    write_archive(folder_ / "a.rva", sample);
    archive_.emplace(test::expect_value(Archive::open(folder_ / "a.rva")));
  }
  const Archive* operator->() const { return &*archive_; }
  Result<Archive::Entry> find(const std::vector<Pair>& assignment) const { return archive_->find(assignment); }

 private:
  TemporaryFolder folder_;
  std::optional<Archive> archive_;
};

TEST(Archive, GivesWhatWasAdded) {
  const OpenedArchive archive;
  EXPECT_EQ(fault_of(*archive.operator->(), sample_archive(), true), "");
  EXPECT_EQ(archive->program_count(), 5u);
  EXPECT_EQ(archive->targets(), (std::vector<Target>{kSpirv, kGlsl, kMsl}));
  EXPECT_TRUE(archive->verify());
}

TEST(Archive, TheCheckOfContentsCatchesAnotherShader) {
  const std::string bytes = archive_bytes(sample_archive());
  SampleArchive other = sample_archive();
  other.permutations[3].program.outputs[2].bytes[0] ^= 1;
  EXPECT_EQ(fault_of(bytes, sample_archive(), true), "");
  EXPECT_EQ(fault_of(bytes, other), "a wrong shader");
  other = sample_archive();
  other.permutations[2].absent[0].second = "because";
  EXPECT_EQ(fault_of(bytes, other), "other absent targets");
  other = sample_archive();
  other.permutations[0].values = {0, 0, 0};
  EXPECT_EQ(fault_of(bytes, other), "a permutation is lost");
}

TEST(Archive, BytesDoNotDependOnTheOrderOfAdding) {
  SampleArchive sample = sample_archive();
  const std::string expected = archive_bytes(sample);
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    std::ranges::shuffle(sample.permutations, random);
    ASSERT_EQ(archive_bytes(sample), expected) << "round " << round;
  }
}

TEST(Archive, OutputsOfOneSizeInAnotherOrderAreNotTakenForThoseInPlace) {
  // A spool in order becomes the archive as it lies; equal sizes make one in another order look the same from outside.
  SampleArchive sample{sample_axes(), {}};
  for (const std::uint16_t technique : {0, 1, 2}) {
    const char* names[] = {"aaaa", "bbbb", "cccc"};
    sample.permutations.push_back({{technique, 0, 0}, sample_program(names[technique]), {}});
  }
  const std::string expected = archive_bytes(sample);
  EXPECT_EQ(fault_of(expected, sample, true), "");
  std::ranges::reverse(sample.permutations);
  EXPECT_EQ(archive_bytes(sample), expected);
}

TEST(Archive, BytesDependOnTheProgramsAndTheReasons) {
  const std::string expected = archive_bytes(sample_archive());
  SampleArchive sample = sample_archive();
  sample.permutations[0].program.cost += ' ';
  EXPECT_NE(archive_bytes(sample), expected);
  sample = sample_archive();
  sample.permutations[2].absent.clear();
  EXPECT_NE(archive_bytes(sample), expected);
}

TEST(Archive, BytesDoNotDependOnThreads) {
  SampleArchive sample{{{"n", {}, 0}}, {}};
  for (std::uint16_t i = 0; i < 400; ++i) {
    sample.axes[0].values.push_back(std::to_string(i));
    sample.permutations.push_back({{i}, sample_program(std::to_string(i / 3)), {{kMsl, std::to_string(i % 5)}}});
  }
  const std::string expected = archive_bytes(sample);
  const TemporaryFolder folder;
  ArchiveWriter writer = test::expect_value(ArchiveWriter::create(folder / "a.rva", sample.axes));
  std::vector<std::thread> threads;
  for (std::size_t first = 0; first < 4; ++first) {
    threads.emplace_back([&, first] {
      for (std::size_t i = first; i < sample.permutations.size(); i += 4) add_to(writer, sample.permutations[i]);
    });
  }
  for (std::thread& thread : threads) thread.join();
  ASSERT_TRUE(writer.finish());
  EXPECT_EQ(TemporaryFolder::read(folder / "a.rva"), expected);
}

TEST(Archive, ProgramsThatNoPermutationUsesAreNotWritten) {
  const TemporaryFolder folder;
  ArchiveWriter writer = test::expect_value(ArchiveWriter::create(folder / "a.rva", sample_axes()));
  ASSERT_TRUE(writer.add_program(sample_program("never used", 4000)));
  for (const auto& permutation : sample_archive().permutations) add_to(writer, permutation);
  ASSERT_TRUE(writer.finish());
  EXPECT_EQ(TemporaryFolder::read(folder / "a.rva"), archive_bytes(sample_archive()));
}

TEST(Archive, EqualOutputsLieInItOnce) {
  const std::string bytes = archive_bytes(sample_archive());
  const std::string vertex = "gl_Position";
  const std::size_t first = bytes.find(vertex);
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(bytes.find(vertex, first + 1), std::string::npos);
}

TEST(Archive, TheSamePermutationMayComeTwice) {
  SampleArchive sample = sample_archive();
  for (const auto& permutation : sample_archive().permutations) sample.permutations.push_back(permutation);
  EXPECT_EQ(archive_bytes(sample), archive_bytes(sample_archive()));
}

TEST(Archive, EmptyOnesAndThoseWithoutAxesWork) {
  const SampleArchive empty{sample_axes(), {}};
  EXPECT_EQ(fault_of(archive_bytes(empty), empty, true), "");
  const SampleArchive one{{}, {{{}, sample_program("only"), {}}}};
  EXPECT_EQ(fault_of(archive_bytes(one), one, true), "");
  const SampleArchive bare{{}, {{{}, ProgramImage{}, {{kMsl, "no"}}}}};
  EXPECT_EQ(fault_of(archive_bytes(bare), bare, true), "");
  EXPECT_THAT(OpenedArchive(empty).find({}).error().message, HasSubstr("the archive is empty"));
}

TEST(Archive, LargeBlobsComeThrough) {
  const SampleArchive sample = sample_archive(std::size_t{3} << 20);
  EXPECT_EQ(fault_of(archive_bytes(sample), sample, true), "");
}

TEST(ArchiveKey, IsThatOfTheDocumentedHash) {
  // Computed apart from docs/archive.md.
  static_assert(axis_key("technique", "relief") == 0x1262a96589790445ull);
  static_assert(axis_key("address", "clamp") == 0x52dca763a6c11993ull);
  const OpenedArchive archive;
  const std::vector<Pair> assignment = {{"address", "clamp"}, {"technique", "relief"}, {"steps", "16"}};
  EXPECT_EQ(archive->key(assignment), axis_key("technique", "relief") + axis_key("address", "clamp"));
}

TEST(ArchiveKey, FindsWhateverTheOrderOfAxes) {
  const OpenedArchive archive;
  const auto one = archive.find({{"technique", "relief"}, {"steps", "8"}, {"address", "clamp"}});
  const auto two = archive.find({{"address", "clamp"}, {"technique", "relief"}, {"steps", "8"}});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(*one, *two);
  EXPECT_EQ(archive->name(*one), "technique=relief address=clamp steps=8");
}

TEST(ArchiveKey, StaysWhenAnAxisIsAddedLater) {
  const OpenedArchive before;
  SampleArchive sample = sample_archive();
  sample.axes.insert(sample.axes.begin() + 1, {"shadow", {"none", "hard"}, 0});
  for (auto& permutation : sample.permutations) permutation.values.insert(permutation.values.begin() + 1, 0);
  const OpenedArchive after(sample);
  for (Archive::Entry entry = 0; entry < before->size(); ++entry) {
    const auto found = after->find(before->key(entry));
    ASSERT_TRUE(found) << before->name(entry);
    EXPECT_EQ(after->name(*found), before->name(entry));
    EXPECT_EQ(*after->load(*found), *before->load(entry));
  }
}

TEST(ArchiveKey, TwoPermutationsOfOneKeyAreRefused) {
  // What an axis at its default adds is nothing, and so is what a missing axis adds.
  const TemporaryFolder folder;
  ArchiveWriter writer = test::expect_value(ArchiveWriter::create(folder / "a.rva", sample_axes()));
  const std::uint32_t program = *writer.add_program(sample_program("x"));
  const std::vector<std::uint16_t> without = {1, 1, kNoValue}, with = {1, 1, 1};
  ASSERT_TRUE(writer.add_permutation(without, program));
  const Status status = writer.add_permutation(with, program);
  EXPECT_EQ(id_of(status), "archive.key-collision");
  EXPECT_THAT(status.error().message, HasSubstr("'technique=relief address=clamp steps=(none)'"));
  EXPECT_THAT(status.error().message, HasSubstr("'technique=relief address=clamp steps=16'"));
}

TEST(ArchiveMissing, AnswersWithTheNearest) {
  const OpenedArchive archive;
  const auto found = archive.find({{"technique", "cone"}, {"steps", "8"}, {"address", "clamp"}});
  EXPECT_EQ(id_of(found), "archive.missing");
  EXPECT_EQ(found.error().message,
            "no permutation technique=cone steps=8 address=clamp; nearest: technique=relief address=clamp steps=8 "
            "(differs in technique: relief), technique=cone address=clamp (differs in steps: 16)");
}

TEST(ArchiveMissing, NamesAtMostThreeNearest) {
  const OpenedArchive archive;
  const std::string message = archive.find({{"technique", "cones"}}).error().message;
  EXPECT_EQ(message,
            "no permutation technique=cones; axis technique has no value 'cones'; it has bump, relief, cone; nearest: "
            "(every axis at its default) (differs in technique: bump), technique=relief (differs in technique: "
            "relief), technique=cone (differs in technique: cone)");
}

TEST(ArchiveMissing, AdvisesOnAxes) {
  const OpenedArchive archive;
  EXPECT_THAT(archive.find({{"adress", "clamp"}}).error().message,
              HasSubstr("there is no axis 'adress'; did you mean 'address'?"));
  EXPECT_THAT(archive.find({{"quality", "high"}}).error().message, HasSubstr("there are technique, address, steps"));
  EXPECT_THAT(archive.find({{"steps", "8"}, {"steps", "8"}, {"technique", "relief"}}).error().message,
              HasSubstr("axis steps is given twice"));
}

TEST(ArchiveOutput, OfAnAbsentTargetComesWithTheReason) {
  const OpenedArchive archive;
  const Archive::Entry entry = *archive.find({{"technique", "relief"}});
  const auto output = archive->output(entry, ShaderStage::fragment, kMsl);
  EXPECT_EQ(id_of(output), "archive.no-output");
  EXPECT_EQ(output.error().code, ErrorCode::unsupported);
  EXPECT_EQ(output.error().message,
            "permutation technique=relief has no msl-2.2: geometry shaders are not in MSL; use prism_pulled");
}

TEST(ArchiveOutput, ThatIsNotThereNamesThoseThatAre) {
  const OpenedArchive archive;
  const auto output = archive->output(*archive.find({{"technique", "cone"}}), ShaderStage::compute, kGlsl);
  EXPECT_EQ(id_of(output), "archive.no-output");
  EXPECT_EQ(output.error().code, ErrorCode::usage);
  EXPECT_THAT(output.error().message, HasSubstr("no compute shader for glsl-450; it has vertex spirv-1.0, vertex "
                                                "glsl-450, fragment spirv-1.0, fragment glsl-450, fragment msl-2.2"));
}

TEST(ArchiveOutput, IsListedWithItsSize) {
  const OpenedArchive archive;
  const auto outputs = archive->outputs(*archive.find({{"technique", "cone"}}));
  ASSERT_EQ(outputs.size(), 5u);
  EXPECT_EQ(outputs[0], (ArchiveOutput{ShaderStage::vertex, kSpirv, 16}));
  EXPECT_EQ(archive->stages(0), (std::vector<ShaderStage>{ShaderStage::vertex, ShaderStage::fragment}));
}

TEST(ArchiveEntry, BeyondTheLastIsAnError) {
  const OpenedArchive archive;
  const auto beyond = static_cast<Archive::Entry>(archive->size());
  EXPECT_EQ(id_of(archive->output(beyond, ShaderStage::vertex, kGlsl)), "archive.entry");
  EXPECT_EQ(id_of(archive->load(beyond)), "archive.entry");
  EXPECT_EQ(id_of(archive->cost(beyond)), "archive.entry");
  EXPECT_TRUE(archive->values(beyond).empty() && archive->outputs(beyond).empty() && archive->name(beyond).empty());
}

TEST(ArchiveWriter, RefusesAxesThatAreNone) {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::vector<ArchiveAxis>, std::string>> cases = {
      {{{"a", {"x"}, 0}, {"a", {"y"}, 0}}, "there are two axes 'a'"},
      {{{"a", {"x", "y", "x"}, 0}}, "axis 'a' has the value 'x' twice"},
      {{{"a", {"x"}, 1}}, "the default of axis 'a' is value 1; it has 1"},
      {{{"a", {}, 0}}, "axis 'a' has 0 values; expected 1 to 65534"},
      {{{"a", std::vector<std::string>(65535), 0}}, "axis 'a' has 65535 values; expected 1 to 65534"},
      {{{"", {"x"}, 0}}, "an axis has no name"},
      {{{"a=b", {"x"}, 0}}, "the name of axis 'a=b' has an '='"}};
  for (const auto& [axes, message] : cases) {
    const auto writer = ArchiveWriter::create(folder / "a.rva", axes);
    EXPECT_EQ(id_of(writer), "archive.axes");
    EXPECT_EQ(writer ? "" : writer.error().message, message);
  }
  EXPECT_EQ(folder.count(), 0u);
}

TEST(ArchiveWriter, RefusesValuesThatAreNone) {
  const TemporaryFolder folder;
  ArchiveWriter writer = test::expect_value(ArchiveWriter::create(folder / "a.rva", sample_axes()));
  const std::uint32_t program = *writer.add_program(sample_program("x"));
  const std::vector<std::uint16_t> right = {0, 0, 0}, short_one = {0, 0}, beyond = {0, 2, 0};
  EXPECT_EQ(id_of(writer.add_permutation(short_one, program)), "archive.values");
  EXPECT_EQ(id_of(writer.add_permutation(beyond, program)), "archive.values");
  EXPECT_EQ(id_of(writer.add_permutation(right, program + 1)), "archive.values");
  const std::vector<std::pair<Target, std::string>> twice = {{kMsl, "one"}, {kMsl, "two"}};
  EXPECT_EQ(id_of(writer.add_permutation(right, program, twice)), "archive.values");
  const std::pair<Target, std::string> there[] = {{sample_program("x").outputs.front().target, "no"}};
  EXPECT_EQ(id_of(writer.add_permutation(right, program, there)), "archive.values");
  EXPECT_EQ(id_of(writer.add_permutation(right, program)), "");
}

TEST(ArchiveWriter, RefusesTwoProgramsForOnePermutation) {
  const TemporaryFolder folder;
  ArchiveWriter writer = test::expect_value(ArchiveWriter::create(folder / "a.rva", sample_axes()));
  const std::uint32_t x = *writer.add_program(sample_program("x")), y = *writer.add_program(sample_program("y"));
  EXPECT_EQ(*writer.add_program(sample_program("x")), x);
  const std::vector<std::uint16_t> values = {0, 0, 0};
  const std::vector<std::pair<Target, std::string>> absent = {{kMsl, "why"}};
  ASSERT_TRUE(writer.add_permutation(values, x));
  EXPECT_EQ(id_of(writer.add_permutation(values, y)), "archive.conflict");
  EXPECT_EQ(id_of(writer.add_permutation(values, x, absent)), "archive.conflict");
}

TEST(ArchiveWriter, RefusesOutputsThatAreNotInOrder) {
  const TemporaryFolder folder;
  ArchiveWriter writer = test::expect_value(ArchiveWriter::create(folder / "a.rva", sample_axes()));
  ProgramImage program = sample_program("x");
  std::swap(program.outputs[0], program.outputs[1]);
  EXPECT_EQ(id_of(writer.add_program(program)), "archive.program");
  program.outputs[1] = program.outputs[0];
  EXPECT_EQ(id_of(writer.add_program(program)), "archive.program");
}

TEST(ArchiveWriter, LeavesNothingWhenItIsNotFinished) {
  const TemporaryFolder folder;
  folder.write("a.rva", "what was there");
  {
    ArchiveWriter writer = test::expect_value(ArchiveWriter::create(folder / "a.rva", sample_axes()));
    add_to(writer, sample_archive().permutations[0]);
  }
  EXPECT_EQ(folder.count(), 1u);
  EXPECT_EQ(TemporaryFolder::read(folder / "a.rva"), "what was there");
}

TEST(ArchiveWriter, WritesThroughALinkAndLeavesIt) {
  const TemporaryFolder folder;
  folder.write("target.rva", "what was there");
  std::filesystem::create_symlink("target.rva", folder / "a.rva");
  write_archive(folder / "a.rva", sample_archive());
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "a.rva"));
  EXPECT_EQ(TemporaryFolder::read(folder / "target.rva"), archive_bytes(sample_archive()));
  EXPECT_EQ(folder.count(), 2u);
}

TEST(ArchiveWriter, RefusesALinkThatLeadsToItself) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("a.rva", folder / "a.rva");
  EXPECT_EQ(id_of(ArchiveWriter::create(folder / "a.rva", sample_axes())), "archive.write");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "a.rva"));
  EXPECT_EQ(folder.count(), 1u);
}

TEST(ArchiveWriter, FinishesOnce) {
  const TemporaryFolder folder;
  ArchiveWriter writer = test::expect_value(ArchiveWriter::create(folder / "a.rva", sample_axes()));
  const std::uint32_t program = *writer.add_program(sample_program("x"));
  ASSERT_TRUE(writer.finish());
  EXPECT_EQ(folder.count(), 1u);
  EXPECT_EQ(id_of(writer.finish()), "archive.write");
  EXPECT_EQ(id_of(writer.add_program(sample_program("x"))), "archive.write");
  EXPECT_EQ(id_of(writer.add_permutation(std::vector<std::uint16_t>{0, 0, 0}, program)), "archive.write");
}

TEST(ArchiveMerge, GivesTheBytesOfASingleWriter) {
  const SampleArchive sample = sample_archive();
  const std::string expected = archive_bytes(sample);
  for (std::size_t parts = 1; parts <= 5; ++parts) {
    const TemporaryFolder folder;
    std::vector<std::filesystem::path> paths;
    for (std::size_t part = 0; part < parts; ++part) {
      SampleArchive share{sample.axes, {}};
      for (std::size_t i = part; i < sample.permutations.size(); i += parts)
        share.permutations.push_back(sample.permutations[i]);
      share.permutations.push_back(sample.permutations[0]);  // in all of them
      paths.push_back(folder / std::to_string(part));
      write_archive(paths.back(), share);
    }
    std::ranges::reverse(paths);
    ASSERT_TRUE(merge_archives(paths, paths[0]));
    EXPECT_EQ(TemporaryFolder::read(paths[0]), expected) << parts << " parts";
  }
}

TEST(ArchiveMerge, RefusesWhatDoesNotAgree) {
  const TemporaryFolder folder;
  const std::vector<std::filesystem::path> paths = {folder / "one", folder / "two"};
  SampleArchive sample = sample_archive();
  write_archive(paths[0], sample);
  sample.permutations[4].program.cost += "!";
  write_archive(paths[1], sample);
  const Status conflict = merge_archives(paths, folder / "all");
  EXPECT_EQ(id_of(conflict), "archive.conflict");
  EXPECT_THAT(conflict.error().message, HasSubstr("in 'two'"));
  sample.axes[1].values.push_back("clip");
  write_archive(paths[1], sample);
  const Status axes = merge_archives(paths, folder / "all");
  EXPECT_EQ(id_of(axes), "archive.axes");
  EXPECT_THAT(axes.error().message, HasSubstr("axis 'address' has the values repeat, clamp, clip"));
  EXPECT_EQ(id_of(merge_archives({}, folder / "all")), "archive.no-parts");
  EXPECT_FALSE(std::filesystem::exists(folder / "all"));
}

TEST(ArchiveOpen, NamesBothVersions) {
  std::string bytes = archive_bytes(sample_archive());
  bytes[8] = 7;
  const TemporaryFolder folder;
  const auto archive = Archive::open(folder.write("a.rva", bytes));
  EXPECT_EQ(id_of(archive), "archive.version");
  EXPECT_THAT(archive.error().message, HasSubstr("is an archive of version 7; this program reads version 1"));
}

TEST(ArchiveOpen, RefusesWhatIsNoArchive) {
  const TemporaryFolder folder;
  EXPECT_EQ(id_of(Archive::open(folder / "missing")), "archive.open");
  EXPECT_EQ(id_of(Archive::open(folder.path())), "archive.open");
  EXPECT_EQ(id_of(Archive::open(folder.write("empty", ""))), "archive.format");
  EXPECT_EQ(id_of(Archive::open(folder.write("text", std::string(5000, 'x')))), "archive.format");
  const std::string bytes = archive_bytes(sample_archive());
  EXPECT_EQ(id_of(Archive::open(folder.write("longer", bytes + std::string(8, '\0')))), "archive.format");
  const test::AlignedBytes shifted("12345678" + bytes);
  EXPECT_TRUE(Archive::from_memory(shifted.span().subspan(8)));
  EXPECT_EQ(id_of(Archive::from_memory(shifted.span().subspan(4))), "archive.format");
}

TEST(ArchiveFormat, IsThatOfTheStoredInputs) {
  // A change of the format needs a new version: files that users have must not change their meaning.
  for (const auto& [name, bytes] : test::stored_inputs()) {
    const std::string stored = TemporaryFolder::read(RELIEVO_SOURCE_DIR "/tests/fuzz/corpus/" + name);
    EXPECT_FALSE(stored.empty()) << name;
    EXPECT_EQ(bytes, stored) << name;
  }
}

TEST(Program, ComesBackFromItsBytes) {
  for (const ProgramImage& program : {sample_program("one"), sample_program("", 0), ProgramImage{}}) {
    const auto read = read_program(write_program(program));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, program);
  }
}

TEST(Program, DamageIsRefused) {
  const std::string bytes = write_program(sample_program("one"));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string flipped = bytes;
    flipped[at] ^= 1;
    ASSERT_EQ(id_of(read_program(flipped)), "archive.program") << at;
    ASSERT_EQ(id_of(read_program(bytes.substr(0, at))), "archive.program") << at;
  }
  EXPECT_EQ(id_of(read_program(bytes + '\0')), "archive.program");
  ProgramImage unordered = sample_program("one");
  std::swap(unordered.outputs[0], unordered.outputs[1]);
  EXPECT_EQ(id_of(read_program(write_program(unordered))), "archive.program");
}

}  // namespace
}  // namespace relievo
