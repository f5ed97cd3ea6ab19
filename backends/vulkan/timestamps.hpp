/// How long each command takes, by the device's clock.
#pragma once

#include <vector>

#include "device.hpp"

namespace relievo::vulkan {

class Timestamps {
 public:
  /// Measures nothing where the device has no timestamps.
  Timestamps(const Device& device, std::size_t command_count);

  void reset(VkCommandBuffer commands) const;
  void begin(VkCommandBuffer commands, std::size_t command) const;
  void end(VkCommandBuffer commands, std::size_t command) const;

  /// One duration a command, once the commands have run; empty without timestamps.
  std::vector<double> seconds() const;

 private:
  void write(VkCommandBuffer commands, std::size_t query) const;

  const Device& device_;
  std::size_t command_count_;
  Unique<VkQueryPool> pool_;
};

}  // namespace relievo::vulkan
