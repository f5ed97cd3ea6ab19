/// One table of a scene: optional fields that keep their default when absent, with the ranges of a scene.
#pragma once

#include <array>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include "describe/toml_reader.hpp"

namespace relievo {

/// An interval of reals and how an error sentence calls it.
struct NumberRange {
  double low, high;
  bool open;  ///< the ends are excluded
  const char* title;
};

namespace ranges {
inline constexpr NumberRange any = {-3.5e38, 3.5e38, false, "a finite number"};
inline constexpr NumberRange positive = {0, 3.5e38, true, "a number above 0"};
inline constexpr NumberRange not_negative = {0, 3.5e38, false, "0 or more"};
inline constexpr NumberRange unit = {0, 1, false, "a number from 0 to 1"};
inline constexpr NumberRange angle = {0, 180, true, "an angle between 0 and 180 degrees"};
}  // namespace ranges

class SceneSection {
 public:
  /// `table` outlives the section.
  SceneSection(const TomlValue& table, std::string label, FirstError& errors);

  void allow_keys(std::initializer_list<std::string_view> keys) { reader_.allow_keys(keys); }
  bool has(std::string_view key) const { return reader_.has(key); }

  void number(std::string_view key, float& value, const NumberRange& range = ranges::any);
  void integer(std::string_view key, int& value, int minimum, int maximum);
  void pair(std::string_view key, std::array<float, 2>& value) {
    numbers(key, value.data(), value.size(), ranges::any);
  }
  void vector(std::string_view key, std::array<float, 3>& value, const NumberRange& range = ranges::any) {
    numbers(key, value.data(), value.size(), range);
  }
  /// A required path; a relative one is joined to `folder`.
  void path(std::string_view key, const std::filesystem::path& folder, std::filesystem::path& value);
  template <class Enum, std::size_t N>
  void choice(std::string_view key, const std::array<std::string_view, N>& known, Enum& value) {
    value = reader_.choice_of<Enum>(key, known, value);
  }
  /// Reports a value that is legal by itself but not with the others.
  void report(std::string message, std::string_view key) { reader_.report("scene.range", std::move(message), key); }

 private:
  void numbers(std::string_view key, float* values, std::size_t count, const NumberRange& range);

  const TomlValue* table_;
  TomlReader reader_;
};

}  // namespace relievo
