/// The folder first, then the remote store behind it.
#include "relievo/cache.hpp"

#include <fmt/format.h>

#include "permute/cache/entry.hpp"
#include "permute/cache/folder.hpp"
#include "permute/cache/local_store.hpp"
#include "permute/cache/remote_store.hpp"

namespace relievo {

namespace cache {
namespace {

constexpr std::uint64_t kLeastBytes = std::uint64_t{1} << 20;

class LayeredCache final : public Cache {
 public:
  LayeredCache(const CacheOptions& options, std::string folder, std::optional<RemoteAddress> address)
      : events_(options.log), local_(std::move(folder), options.max_bytes, events_) {
    if (address) remote_.emplace(*std::move(address), options.remote, options.remote_timeout, events_);
  }

  std::optional<std::string> load(const CacheKey& key) override {
    if (auto payload = local_.load(key)) {
      ++events_.hits;
      return payload;
    }
    if (auto payload = load_remote(key)) {
      ++events_.remote_hits;
      return payload;
    }
    ++events_.misses;
    return std::nullopt;
  }

  void store(const CacheKey& key, std::string_view payload) override {
    const EntryHeader bytes = entry_header(key, payload);
    const std::string_view header(bytes.data(), bytes.size());
    if (local_.store(key, header, payload)) ++events_.stores;
    if (remote_ && payload.size() <= kMaxPayload) remote_->store(key, header, payload);
  }

  CacheCounts counts() const override { return events_.counts(); }

 private:
  std::optional<std::string> load_remote(const CacheKey& key) {
    if (!remote_) return std::nullopt;
    const std::optional<std::string> bytes = remote_->load(key);
    if (!bytes) return std::nullopt;
    if (const std::string fault = entry_fault(*bytes, key); !fault.empty()) {
      ++events_.broken;
      events_.say(fmt::format("the remote cache's entry {} is damaged and is removed: {}", to_string(key), fault));
      remote_->remove(key);
      return std::nullopt;
    }
    const std::string_view header = std::string_view(*bytes).substr(0, kHeaderSize);
    const std::string_view payload = std::string_view(*bytes).substr(kHeaderSize);
    local_.store(key, header, payload);
    return std::string(payload);
  }

  Events events_;
  LocalStore local_;
  std::optional<RemoteStore> remote_;
};

}  // namespace
}  // namespace cache

Result<std::unique_ptr<Cache>> open_cache(const CacheOptions& options) {
  if (options.max_bytes < cache::kLeastBytes) {
    return fail(
        ErrorCode::usage, "cache.size",
        fmt::format("the cache may have {} bytes; expected at least {}", options.max_bytes, cache::kLeastBytes));
  }
  std::optional<cache::RemoteAddress> address;
  if (!options.remote.empty()) {
    Result<cache::RemoteAddress> parsed = cache::parse_remote_address(options.remote);
    if (!parsed) return tl::unexpected(parsed.error());
    if (options.remote_timeout.count() < 1) {
      return fail(
          ErrorCode::usage, "cache.remote",
          fmt::format("the remote cache's timeout is {} ms; expected at least 1", options.remote_timeout.count()));
    }
    address = *std::move(parsed);
  }
  Result<std::string> folder = cache::prepare_folder(options.folder);
  if (!folder) return tl::unexpected(folder.error());
  return std::make_unique<cache::LayeredCache>(options, *std::move(folder), std::move(address));
}

}  // namespace relievo
