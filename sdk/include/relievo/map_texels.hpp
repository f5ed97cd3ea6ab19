/// The texels of a map in memory, in as many bits as its texture has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace relievo {

/// Values that read as floats: k / (2^bits − 1) of 8 or 16 bits, or floats of 32. Reading is thread-safe.
class MapTexels {
 public:
  /// Floats, or the k of 8 and 16 bits.
  using Values = std::variant<std::vector<float>, std::vector<std::uint8_t>, std::vector<std::uint16_t>>;

  MapTexels() = default;
  MapTexels(Values values) : values_(std::move(values)) {}  // a list of floats is as good as texels
  MapTexels(std::vector<float> values) : values_(std::move(values)) {}
  /// Each value as the nearest that `bits` (8, 16; or 32: as they are) hold.
  MapTexels(std::span<const float> values, int bits);

  int bits() const;  ///< 8, 16 or 32
  std::size_t size() const;
  bool empty() const { return size() == 0; }
  float operator[](std::size_t i) const;
  /// Stores the nearest value that the bits hold.
  void set(std::size_t i, float value);
  std::vector<float> floats() const;
  const Values& values() const { return values_; }
  friend bool operator==(const MapTexels&, const MapTexels&) = default;

 private:
  Values values_;
};

}  // namespace relievo
