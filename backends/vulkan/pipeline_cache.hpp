/// The driver's compiled pipelines, kept in a file between runs.
#pragma once

#include <filesystem>
#include <string>

#include "device.hpp"

namespace relievo::vulkan {

class PipelineCache {
 public:
  /// Starts from the file's contents; one that is missing, damaged or of another device counts as empty. An empty
  /// path keeps the cache in memory only.
  PipelineCache(const Device& device, std::filesystem::path path);

  VkPipelineCache handle() const { return cache_.get(); }

  /// Writes the file if there is something new; readers see the old file or the new one. Returns what is wrong, or
  /// an empty string.
  std::string save();

 private:
  const Device& device_;
  std::filesystem::path path_;
  Unique<VkPipelineCache> cache_;
  std::uint64_t saved_hash_ = 0;
};

}  // namespace relievo::vulkan
