/// The axes of a permutation and their names.
#include <fmt/format.h>
#include <array>

#include "relievo/compose.hpp"

namespace relievo {

namespace {

constexpr std::array<std::string_view, 2> filter_names = {"hardware", "exact"};
constexpr std::array<std::string_view, 8> aov_names = {"color", "depth",  "normal",     "uv",
                                                       "steps", "status", "ray_origin", "ray_direction"};

template <class Enum, std::size_t N>
Result<Enum> parse(std::string_view name, const std::array<std::string_view, N>& names, std::string_view what) {
  for (std::size_t i = 0; i < N; ++i) {
    if (names[i] == name) return static_cast<Enum>(i);
  }
  std::vector<std::string> known(names.begin(), names.end());
  std::string nearest = nearest_name(name, known);
  return fail(ErrorCode::usage, fmt::format("compose.unknown-{}", what),
              fmt::format("{} '{}' is unknown; expected {}{}", what, name, fmt::join(known, ", "),
                          nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

}  // namespace

std::string_view to_string(HeightFilter filter) {
  return filter_names[static_cast<std::size_t>(filter)];
}
std::string_view to_string(Aov aov) {
  return aov_names[static_cast<std::size_t>(aov)];
}

Result<HeightFilter> parse_height_filter(std::string_view name) {
  return parse<HeightFilter>(name, filter_names, "filter");
}

Result<Aov> parse_aov(std::string_view name) {
  return parse<Aov>(name, aov_names, "aov");
}

std::string Permutation::key() const {
  std::string key = stage;
  for (const auto& [role, technique] : roles) key += fmt::format("/{}={}", role, technique);
  key += fmt::format("/{}/{}/{}", to_string(filter), to_string(address), to_string(aov));
  if (count_cost) key += "/counted";
  for (const auto& [name, time] : binding_times) key += fmt::format("/{}:{}", name, to_string(time));
  for (const auto& [name, value] : values) key += fmt::format("/{}={}", name, value);
  return key;
}

}  // namespace relievo
