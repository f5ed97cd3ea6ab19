/// Whatever happens to a cache's files: the bytes that were stored, or nothing.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <thread>

#include "permute/cache/entry.hpp"
#include "support/caches.hpp"
#include "support/files.hpp"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;

void overwrite(const fs::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// One entry whose file is damaged again and again.
class DamagedEntry {
 public:
  explicit DamagedEntry(std::size_t size) : size_(size), cache_(folder_.path()) {
    cache_->store(numbered_key(1), numbered_payload(1, size));
    file_ = entry_file(folder_.path(), numbered_key(1));
    sound_ = TemporaryFolder::read(file_);
  }
  const std::string& sound() const { return sound_; }
  void load_as(std::string_view bytes, Cache& cache) {
    overwrite(file_, bytes);
    judge(answers_, cache, 1, size_);
    left_ += fs::exists(file_) ? 1 : 0;
  }
  void load_as(std::string_view bytes) { load_as(bytes, *cache_); }
  const Answers& answers() const { return answers_; }
  int left() const { return left_; }  ///< files that lie there after their load
  CacheCounts counts() { return cache_->counts(); }
  std::size_t said() { return cache_.said().size(); }
  const fs::path& file() const { return file_; }

 private:
  TemporaryFolder folder_;
  std::size_t size_;
  LoggedCache cache_;
  fs::path file_;
  std::string sound_;
  Answers answers_;
  int left_ = 0;
};

/// A cache that trusts what it reads.
class TrustingCache : public Cache {
 public:
  explicit TrustingCache(fs::path file) : file_(std::move(file)) {}
  std::optional<std::string> load(const CacheKey&) override {
    const std::string bytes = TemporaryFolder::read(file_);
    if (bytes.size() < cache::kHeaderSize) return std::nullopt;
    return bytes.substr(cache::kHeaderSize);
  }
  void store(const CacheKey&, std::string_view) override {}
  CacheCounts counts() const override { return {}; }

 private:
  fs::path file_;
};

template <class Load>
void flip_every_bit(const std::string& sound, Load load) {
  for (std::size_t bit = 0; bit < 8 * sound.size(); ++bit) {
    std::string bytes = sound;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    load(bytes);
  }
}

TEST(CacheEntry, EveryFlippedBitIsAMiss) {
  DamagedEntry entry(200);
  flip_every_bit(entry.sound(), [&](const std::string& bytes) { entry.load_as(bytes); });
  const int flips = static_cast<int>(8 * entry.sound().size());
  EXPECT_EQ(entry.answers().none, flips);
  EXPECT_EQ(entry.counts().broken, static_cast<std::uint64_t>(flips));
  EXPECT_EQ(entry.said(), static_cast<std::size_t>(flips));
  EXPECT_EQ(entry.left(), 0);
  entry.load_as(entry.sound());
  EXPECT_EQ(entry.answers().right, 1);
}

TEST(CacheEntry, TrustingCacheIsCaughtByTheSameFlips) {
  DamagedEntry entry(20);
  TrustingCache trusting(entry.file());
  flip_every_bit(entry.sound(), [&](const std::string& bytes) { entry.load_as(bytes, trusting); });
  EXPECT_EQ(entry.answers().wrong, 8 * 20);
}

TEST(CacheEntry, EveryFlippedByteOfARealSizeIsFound) {
  const CacheKey key = numbered_key(1);
  const std::string payload = numbered_payload(1, 80'000);
  const cache::EntryHeader header = cache::entry_header(key, payload);
  std::string bytes = std::string(header.data(), header.size()) + payload;
  ASSERT_EQ(cache::entry_fault(bytes, key), "");
  int missed = 0;
  for (char& byte : bytes) {
    byte = static_cast<char>(~byte);
    missed += cache::entry_fault(bytes, key).empty() ? 1 : 0;
    byte = static_cast<char>(~byte);
  }
  EXPECT_EQ(missed, 0);
}

TEST(CacheEntry, EveryTruncationAndEveryTailIsAMiss) {
  DamagedEntry entry(300);
  const std::string sound = entry.sound();
  for (std::size_t size = 0; size < sound.size(); ++size) entry.load_as(sound.substr(0, size));
  for (std::size_t more = 1; more < 100; ++more) entry.load_as(sound + std::string(more, '\0'));
  EXPECT_EQ(entry.answers().none, static_cast<int>(sound.size()) + 99);
  EXPECT_EQ(entry.left(), 0);
}

/// One random damage: bits, a run of bytes, a cut, a tail, a hole of zeros, a moved block, or another entry's bytes.
std::string damaged(const std::string& sound, const std::string& other, std::mt19937& random) {
  const auto below = [&](std::size_t limit) { return random() % std::max<std::size_t>(1, limit); };
  std::string bytes = sound;
  const std::size_t at = below(bytes.size()), length = 1 + below(bytes.size() - at);
  switch (random() % 7) {
    case 0:
      for (std::size_t flips = 1 + below(8); flips > 0; --flips) {
        char& byte = bytes[below(bytes.size())];
        byte = static_cast<char>(byte ^ (1 << below(8)));
      }
      return bytes;
    case 1:
      for (std::size_t i = at; i < at + std::min<std::size_t>(length, 64); ++i) bytes[i] = static_cast<char>(random());
      return bytes;
    case 2:
      return bytes.substr(0, at);
    case 3:
      return bytes + other.substr(0, length);
    case 4:
      return bytes.replace(at, length, length, '\0');
    case 5:
      return bytes.substr(at) + bytes.substr(0, at);
    default:
      return other.substr(0, at) + bytes.substr(at);
  }
}

void corrupt_at_random(int times, std::size_t size) {
  DamagedEntry entry(size), other(size);
  std::mt19937 random(4);
  const CacheKey key = numbered_key(2);
  const cache::EntryHeader header = cache::entry_header(key, numbered_payload(2, size));
  const std::string other_bytes = std::string(header.data(), header.size()) + numbered_payload(2, size);
  int unchanged = 0;
  for (int i = 0; i < times; ++i) {
    const std::string bytes = damaged(entry.sound(), other_bytes, random);
    unchanged += bytes == entry.sound() ? 1 : 0;
    entry.load_as(bytes);
  }
  const Answers answers = entry.answers();
  std::printf("%d corruptions: %d misses, %d wrong answers; %d were none, %d answered\n", times, answers.none,
              answers.wrong, unchanged, answers.right);
  EXPECT_EQ(answers.wrong, 0);
  EXPECT_EQ(answers.right, unchanged);
  EXPECT_EQ(entry.counts().broken, static_cast<std::uint64_t>(times - unchanged));
}

TEST(CacheEntry, RandomCorruptionsAreMisses) {
  corrupt_at_random(1000, 2000);
}
TEST(LongCacheEntry, TenThousandRandomCorruptionsAreMisses) {
  corrupt_at_random(5000, 500);
  corrupt_at_random(5000, 80'000);
}

// A reader that holds a damaged file removes that one, and not the sound one that was just renamed over it.
TEST(CacheEntry, RemovingADamagedFileSparesANewOne) {
  const TemporaryFolder folder;
  LoggedCache reader(folder.path()), writer(folder.path());
  const CacheKey key = numbered_key(1);
  const std::string payload = numbered_payload(1, 3000);
  writer->store(key, payload);
  const fs::path file = entry_file(folder.path(), key);
  const std::string half = TemporaryFolder::read(file).substr(0, 2000);
  int lost = 0;
  for (int i = 0; i < 400; ++i) {
    overwrite(folder / "half", half);
    fs::rename(folder / "half", file);
    std::atomic<int> ready = 0;
    const auto meet = [&ready] {
      ++ready;
      while (ready < 2) std::this_thread::yield();
    };
    std::thread reading([&] {
      meet();
      reader->load(key);
    });
    meet();
    for (int spin = (i * 37) % 1000; spin > 0; --spin) asm volatile("");
    writer->store(key, payload);
    reading.join();
    lost += writer->load(key) == payload ? 0 : 1;
  }
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace relievo::test
