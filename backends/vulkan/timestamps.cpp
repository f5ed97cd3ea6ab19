#include "timestamps.hpp"

namespace relievo::vulkan {

Timestamps::Timestamps(const Device& device, std::size_t command_count)
    : device_(device), command_count_(command_count) {
  if (device.traits().timestamp_bits == 0 || command_count == 0) return;
  const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                      .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                      .queryCount = static_cast<std::uint32_t>(2 * command_count)};
  pool_ = device.create(device.vk.vkCreateQueryPool, device.vk.vkDestroyQueryPool, info, "creating timestamps");
}

void Timestamps::reset(VkCommandBuffer commands) const {
  if (!pool_) return;
  device_.vk.vkCmdResetQueryPool(commands, pool_.get(), 0, static_cast<std::uint32_t>(2 * command_count_));
}

void Timestamps::begin(VkCommandBuffer commands, std::size_t command) const {
  write(commands, 2 * command);
}

void Timestamps::end(VkCommandBuffer commands, std::size_t command) const {
  write(commands, 2 * command + 1);
}

void Timestamps::write(VkCommandBuffer commands, std::size_t query) const {
  if (!pool_) return;
  device_.vk.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_.get(),
                                  static_cast<std::uint32_t>(query));
}

std::vector<double> Timestamps::seconds() const {
  if (!pool_) return {};
  std::vector<std::uint64_t> ticks(2 * command_count_);
  check(device_.vk.vkGetQueryPoolResults(device_.handle(), pool_.get(), 0, static_cast<std::uint32_t>(ticks.size()),
                                         ticks.size() * sizeof(std::uint64_t), ticks.data(), sizeof(std::uint64_t),
                                         VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "reading timestamps");
  // The counter may have fewer than 64 bits and wrap around between the two.
  const std::uint64_t mask = ~std::uint64_t{0} >> (64 - device_.traits().timestamp_bits);
  const double seconds_per_tick = 1e-9 * static_cast<double>(device_.limits().timestampPeriod);
  std::vector<double> durations;
  for (std::size_t i = 0; i < command_count_; ++i) {
    durations.push_back(static_cast<double>((ticks[2 * i + 1] - ticks[2 * i]) & mask) * seconds_per_tick);
  }
  return durations;
}

}  // namespace relievo::vulkan
