#include <fmt/format.h>
#include <functional>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

MapSet& BakedMaps::of(const HeightMap& height, const std::string& backend) {
  const std::string_view bytes(reinterpret_cast<const char*>(height.texels.data()),
                               height.texels.size() * sizeof(float));
  const std::string key = fmt::format("{} {}x{} {} {}", shared_ ? "all" : backend, height.width, height.height,
                                      to_string(height.address), std::hash<std::string_view>{}(bytes));
  auto [entry, is_new] = sets_.try_emplace(key);
  if (is_new) entry->second = map_set(height);
  return entry->second;
}

}  // namespace relievo::cli
