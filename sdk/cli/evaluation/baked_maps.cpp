#include <fmt/format.h>
#include <functional>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

MapSet& BakedMaps::of(const Registry& registry, const HeightMap& height, const std::string& backend,
                      const std::map<std::string, double>& values) {
  const std::string_view bytes(reinterpret_cast<const char*>(height.texels.data()),
                               height.texels.size() * sizeof(float));
  std::string key = fmt::format("{} {}x{} {} {}", shared_ ? "all" : backend, height.width, height.height,
                                to_string(height.address), std::hash<std::string_view>{}(bytes));
  const KnownParameters known = known_parameters(registry);
  for (const auto& [name, value] : values) {
    if (name.ends_with(".scale") && known.at(name)->value != value) key += fmt::format(" {}={}", name, value);
  }
  auto [entry, is_new] = sets_.try_emplace(key);
  if (is_new) entry->second = map_set(height);
  return entry->second;
}

}  // namespace relievo::cli
