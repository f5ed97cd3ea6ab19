#include "pipeline_cache.hpp"

#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include "files/whole_file.hpp"

namespace relievo::vulkan {

namespace {

// The file is the hash of what follows, then the driver's data. Drivers check only the header of their data, so a
// damaged file must not reach them; the data of another device they ignore themselves.
using Hash = std::uint64_t;

Hash hash_of(const std::vector<char>& data) {
  return XXH3_64bits(data.data(), data.size());
}

std::vector<char> load(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  std::vector<char> data{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  Hash stored = 0;
  if (data.size() < sizeof stored) return {};
  std::memcpy(&stored, data.data(), sizeof stored);
  data.erase(data.begin(), data.begin() + sizeof stored);
  return hash_of(data) == stored ? data : std::vector<char>();
}

Status store(const std::filesystem::path& path, const std::vector<char>& data, Hash hash) {
  std::vector<std::uint8_t> bytes(sizeof hash + data.size());
  std::memcpy(bytes.data(), &hash, sizeof hash);
  std::copy(data.begin(), data.end(), bytes.begin() + sizeof hash);
  return write_file(path, bytes, "vulkan.cache");
}

}  // namespace

PipelineCache::PipelineCache(const Device& device, std::filesystem::path path)
    : device_(device), path_(std::move(path)) {
  std::vector<char> data;
  if (!path_.empty()) data = load(path_);
  saved_hash_ = hash_of(data);
  const VkPipelineCacheCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                          .initialDataSize = data.size(),
                                          .pInitialData = data.data()};
  cache_ = device.create(device.vk.vkCreatePipelineCache, device.vk.vkDestroyPipelineCache, info,
                         "creating the pipeline cache");
}

std::string PipelineCache::save() {
  if (path_.empty()) return {};
  std::size_t size = 0;
  check(device_.vk.vkGetPipelineCacheData(device_.handle(), cache_.get(), &size, nullptr), "sizing the pipeline cache");
  std::vector<char> data(size);
  check(device_.vk.vkGetPipelineCacheData(device_.handle(), cache_.get(), &size, data.data()),
        "reading the pipeline cache");
  data.resize(size);
  const Hash hash = hash_of(data);
  if (hash == saved_hash_) return {};
  if (Status status = store(path_, data, hash); !status) return format(status.error());
  saved_hash_ = hash;
  return {};
}

}  // namespace relievo::vulkan
