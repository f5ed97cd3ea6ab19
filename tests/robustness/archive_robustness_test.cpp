// Whatever happens to an archive or to its writer: it opens to what was put in, or it does not open.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <random>
#include <thread>

#include "support/archive_walk.hpp"
#include "support/archives.hpp"
#include "support/damage.hpp"

namespace relievo {
namespace {

using test::archive_bytes;
using test::fault_of;
using test::sample_archive;
using test::SampleArchive;
using test::TemporaryFolder;

bool is_seen(const std::string& bytes) {
  const test::AlignedBytes aligned(bytes);
  const auto archive = Archive::from_memory(aligned.span());
  return !archive || !archive->verify();
}

TEST(ArchiveRobustness, EveryFlippedByteIsSeenAndHarmless) {
  const SampleArchive sample = sample_archive();
  const std::string bytes = archive_bytes(sample);
  ASSERT_EQ(fault_of(bytes, sample, true), "");
  ASSERT_FALSE(is_seen(bytes));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string flipped = bytes;
      flipped[at] = static_cast<char>(flipped[at] ^ change);
      ASSERT_EQ(fault_of(flipped, sample), "") << "byte " << at;
      ASSERT_TRUE(is_seen(flipped)) << "byte " << at;
    }
  }
}

TEST(ArchiveRobustness, EveryTruncationIsRefused) {
  const std::string bytes = archive_bytes(sample_archive());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const test::AlignedBytes aligned(std::string_view(bytes).substr(0, length));
    const auto archive = Archive::from_memory(aligned.span());
    ASSERT_FALSE(archive) << length;
    ASSERT_EQ(archive.error().id, "archive.format") << length;
  }
}

TEST(ArchiveRobustness, DamageBehindARightHashIsRefusedOrConsistent) {
  const std::string bytes = archive_bytes(sample_archive());
  constexpr std::size_t header_size = 256;
  std::uint64_t index_offset = 0;
  std::memcpy(&index_offset, bytes.data() + 32, sizeof index_offset);
  std::size_t refused = 0, accepted = 0;
  for (std::size_t at = 24; at < bytes.size(); ++at) {
    if (at == header_size) at = static_cast<std::size_t>(index_offset);
    for (const int change : {0x01, 0x02, 0x80, 0xff}) {
      std::string flipped = bytes;
      flipped[at] = static_cast<char>(flipped[at] ^ change);
      test::mend_index_hash(flipped);
      const test::AlignedBytes aligned(flipped);
      const auto archive = Archive::from_memory(aligned.span());
      ++(archive ? accepted : refused);
      ASSERT_EQ(archive ? test::contradiction_of(*archive) : "", "") << "byte " << at;
    }
  }
  // What is accepted are other texts of reasons, other hashes of blobs, other shaders of a program.
  std::cout << refused << " refused, " << accepted << " accepted\n";
  EXPECT_GT(refused, accepted);
}

struct Figures {
  std::size_t rounds = 0, refused = 0, opened = 0, unseen = 0;
};

Figures corrupt(const SampleArchive& sample, int rounds, std::uint32_t seed) {
  const std::string bytes = archive_bytes(sample);
  std::mt19937 random(seed);
  Figures figures;
  for (int round = 0; round < rounds; ++round) {
    const std::string changed = test::damaged(bytes, random);
    const test::AlignedBytes aligned(changed);
    const auto archive = Archive::from_memory(aligned.span());
    ++figures.rounds;
    ++(archive ? figures.opened : figures.refused);
    EXPECT_EQ(archive ? fault_of(*archive, sample, false) : "", "") << "round " << round;
    figures.unseen += changed != bytes && archive && archive->verify();
    if (testing::Test::HasFailure()) break;
  }
  return figures;
}

SampleArchive bigger_archive() {
  SampleArchive sample{{{"technique", {"a", "b", "c"}, 0}, {"n", {}, 0}}, {}};
  for (std::uint16_t i = 0; i < 100; ++i) {
    sample.axes[1].values.push_back(std::to_string(i));
    for (std::uint16_t technique = 0; technique < 3; ++technique)
      sample.permutations.push_back({{technique, i}, test::sample_program(std::to_string(i / 2), 400), {}});
  }
  return sample;
}

TEST(ArchiveRobustness, RandomDamageNeverGivesAWrongShader) {
  const Figures figures = corrupt(sample_archive(400), 2000, 1);
  EXPECT_EQ(figures.unseen, 0u);
  EXPECT_GT(figures.opened, 0u) << "damage to blobs was never tried";
  EXPECT_GT(figures.refused, 0u);
}

TEST(LongArchiveRobustness, TenThousandDamagedArchivesGiveNoWrongShader) {
  const Figures figures = corrupt(bigger_archive(), 10000, 2);
  std::cout << figures.rounds << " damaged: " << figures.refused << " refused, " << figures.opened
            << " opened with every shader right or refused, " << figures.unseen << " unseen by verify\n";
  EXPECT_EQ(figures.rounds, 10000u);
  EXPECT_EQ(figures.unseen, 0u);
}

TEST(ArchiveRobustness, AFolderThatCannotBeWrittenIsAnError) {
  const TemporaryFolder folder;
  const auto id = [](const std::filesystem::path& path) {
    const auto writer = ArchiveWriter::create(path, test::sample_axes());
    return writer ? "" : writer.error().id;
  };
  EXPECT_EQ(id(folder / "missing/a.rva"), "archive.write");
  EXPECT_EQ(id(folder.write("file", "x") / "a.rva"), "archive.write");
  EXPECT_EQ(id("/proc/a.rva"), "archive.write");
  EXPECT_EQ(id(folder.path()), "archive.write");
  EXPECT_EQ(id("/dev/null"), "archive.write");
  EXPECT_EQ(id(""), "archive.write");
}

/// Runs `action` in a process of its own, which may be killed; its value is the exit code.
template <class Action>
pid_t start(const Action& action) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(action());
  return child;
}

int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

/// 0: written, 1: refused as a full disk should be, 2: anything else.
int write_with_limit(const std::filesystem::path& path, const SampleArchive& sample, std::size_t limit) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit most{limit, limit};
  ::setrlimit(RLIMIT_FSIZE, &most);
  try {
    test::write_archive(path, sample);
  } catch (const std::exception& error) {
    return std::string_view(error.what()).find("[archive.write]") == std::string_view::npos ? 2 : 1;
  }
  return 0;
}

TEST(ArchiveRobustness, AFullDiskLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const SampleArchive sample = sample_archive(100000);
  const std::size_t size = archive_bytes(sample).size();
  folder.write("a.rva", "what was there");
  std::size_t refused = 0;
  for (std::size_t limit = 0; limit < size; limit += size / 20) {
    const int status = wait_for(start([&] { return write_with_limit(folder / "a.rva", sample, limit); }));
    ASSERT_EQ(WEXITSTATUS(status), 1) << "at " << limit;
    ASSERT_EQ(TemporaryFolder::read(folder / "a.rva"), "what was there") << "at " << limit;
    ASSERT_EQ(folder.count(), 1u) << "at " << limit;
    ++refused;
  }
  EXPECT_GE(refused, 20u);
  const int status = wait_for(start([&] { return write_with_limit(folder / "a.rva", sample, size); }));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(fault_of(TemporaryFolder::read(folder / "a.rva"), sample, true), "");
}

struct Kills {
  std::size_t rounds = 0, in_finish = 0;
};

/// Kills a writer that finishes two archives by turns, and looks at what lies there.
Kills kill_writers(std::size_t rounds, std::uint32_t seed) {
  const TemporaryFolder folder;
  const SampleArchive one = sample_archive(200000), two = sample_archive(300000);
  test::write_archive(folder / "a.rva", one);
  // Added from back to front, an archive is put in order when it is finished: that takes longer, and is killed more.
  SampleArchive one_backwards = one, two_backwards = two;
  std::ranges::reverse(one_backwards.permutations);
  std::ranges::reverse(two_backwards.permutations);
  std::mt19937 random(seed);
  Kills kills;
  for (; kills.rounds < rounds && !testing::Test::HasFailure(); ++kills.rounds) {
    const pid_t writer = start([&]() -> int {
      for (bool turn = false;; turn = !turn)
        test::write_archive(folder / "a.rva", turn ? one_backwards : two_backwards);
    });
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
    ::kill(writer, SIGKILL);
    EXPECT_TRUE(WIFSIGNALED(wait_for(writer)));
    const auto archive = Archive::open(folder / "a.rva");
    EXPECT_TRUE(archive.has_value()) << archive.error().message;
    const std::string bytes = TemporaryFolder::read(folder / "a.rva");
    EXPECT_TRUE(fault_of(bytes, one, true).empty() || fault_of(bytes, two, true).empty());
    for (const auto& file : std::filesystem::directory_iterator(folder.path())) {
      if (file.path().extension() != ".tmp" && file.path().extension() != ".spool") continue;
      kills.in_finish += file.path().extension() == ".tmp";
      std::filesystem::remove(file.path());
    }
  }
  return kills;
}

TEST(ArchiveRobustness, AKilledWriterLeavesAWholeFile) {
  const Kills kills = kill_writers(40, 1);
  EXPECT_EQ(kills.rounds, 40u);
  EXPECT_GT(kills.in_finish, 0u) << "no writer was killed while it wrote";
}

TEST(LongArchiveRobustness, TwoThousandKilledWritersLeaveAWholeFile) {
  const Kills kills = kill_writers(2000, 2);
  std::cout << kills.rounds << " kills, " << kills.in_finish << " of them while the archive was written\n";
  EXPECT_EQ(kills.rounds, 2000u);
}

TEST(ProgramRobustness, RandomDamageIsRefusedEvenBehindARightHash) {
  const std::string bytes = write_program(test::sample_program("x"));
  std::mt19937 random(3);
  for (int round = 0; round < 20000; ++round) {
    std::string changed = test::damaged(bytes, random);
    const auto plain = read_program(changed);
    ASSERT_TRUE(changed == bytes || !plain);
    test::mend_program_hash(changed);
    // The format has no slack: what is read is written as the same bytes.
    const auto mended = read_program(changed);
    ASSERT_EQ(mended ? write_program(*mended) : changed, changed) << "round " << round;
  }
}

}  // namespace
}  // namespace relievo
