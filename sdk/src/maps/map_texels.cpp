#include "relievo/map_texels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "maps/quantise.hpp"

namespace relievo {

namespace {

template <class Stored>
float read(Stored stored) {
  if constexpr (std::is_same_v<Stored, float>) return stored;
  return static_cast<float>(static_cast<double>(stored) / std::numeric_limits<Stored>::max());
}

template <class Stored>
Stored store(float value) {
  if constexpr (std::is_same_v<Stored, float>) return value;
  const double held = value > 0 ? std::min(static_cast<double>(value), 1.0) : 0.0;  // NaN too
  return static_cast<Stored>(std::lround(held * std::numeric_limits<Stored>::max()));
}

template <class Vector>
using StoredIn = typename std::decay_t<Vector>::value_type;

}  // namespace

MapTexels::MapTexels(std::span<const float> values, int bits) : values_(make_values(bits, values.size())) {
  std::visit(
      [values](auto& stored) {
        for (const float value : values) stored.push_back(store<StoredIn<decltype(stored)>>(value));
      },
      values_);
}

int MapTexels::bits() const {
  return std::visit([](const auto& stored) { return 8 * static_cast<int>(sizeof(StoredIn<decltype(stored)>)); },
                    values_);
}

std::size_t MapTexels::size() const {
  return std::visit([](const auto& stored) { return stored.size(); }, values_);
}

float MapTexels::operator[](std::size_t i) const {
  return std::visit([i](const auto& stored) { return read(stored[i]); }, values_);
}

void MapTexels::set(std::size_t i, float value) {
  std::visit([&](auto& stored) { stored[i] = store<StoredIn<decltype(stored)>>(value); }, values_);
}

std::vector<float> MapTexels::floats() const {
  return std::visit(
      [](const auto& stored) {
        std::vector<float> values(stored.size());
        for (std::size_t i = 0; i < stored.size(); ++i) values[i] = read(stored[i]);
        return values;
      },
      values_);
}

}  // namespace relievo
