/// Caches under test: payloads that their key decides, and what a cache says.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <vector>

#include "relievo/cache.hpp"

namespace relievo::test {

inline CacheKey numbered_key(std::uint64_t number) {
  return cache_key({"test", std::to_string(number)});
}

/// Bytes that every process makes alike, so that what another one stored can be judged.
inline std::string numbered_payload(std::uint64_t number, std::size_t size) {
  std::mt19937_64 random(number * 7919 + size);
  std::string payload(size, '\0');
  for (std::size_t i = 0; i < size; i += 8) {
    const std::uint64_t word = random();
    for (std::size_t j = i; j < std::min(size, i + 8); ++j) payload[j] = static_cast<char>(word >> (8 * (j - i)));
  }
  return payload;
}

/// A cache with what it said.
class LoggedCache {
 public:
  explicit LoggedCache(CacheOptions options) {
    options.log = [this](std::string_view sentence) {
      const std::lock_guard lock(mutex_);
      said_.emplace_back(sentence);
    };
    Result<std::unique_ptr<Cache>> opened = open_cache(options);
    if (!opened) throw std::runtime_error(opened.error().message);
    cache_ = *std::move(opened);
  }
  explicit LoggedCache(const std::filesystem::path& folder) : LoggedCache(options_of(folder)) {}

  Cache* operator->() { return cache_.get(); }
  Cache& operator*() { return *cache_; }
  /// Ends the cache as its user would.
  void close() { cache_.reset(); }
  std::vector<std::string> said() {
    const std::lock_guard lock(mutex_);
    return said_;
  }

 private:
  static CacheOptions options_of(const std::filesystem::path& folder) {
    CacheOptions options;
    options.folder = folder;
    return options;
  }
  std::mutex mutex_;
  std::vector<std::string> said_;
  std::unique_ptr<Cache> cache_;
};

/// How often loads answered with what the key stands for, with nothing, and with something else.
struct Answers {
  int right = 0, none = 0, wrong = 0;
};

inline void judge(Answers& answers, Cache& cache, std::uint64_t number, std::size_t size) {
  const auto payload = cache.load(numbered_key(number));
  if (!payload) {
    ++answers.none;
  } else if (*payload == numbered_payload(number, size)) {
    ++answers.right;
  } else {
    ++answers.wrong;
  }
}

/// The file of an entry, as docs/cache.md says.
inline std::filesystem::path entry_file(const std::filesystem::path& folder, const CacheKey& key) {
  const std::string digits = to_string(key);
  return folder / digits.substr(0, 2) / (digits.substr(2) + ".entry");
}

inline std::size_t file_count(const std::filesystem::path& folder, const std::string& ending) {
  std::size_t count = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder)) {
    if (file.path().filename().string().ends_with(ending)) ++count;
  }
  return count;
}

}  // namespace relievo::test
