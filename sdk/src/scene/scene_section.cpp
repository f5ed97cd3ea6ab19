#include "scene/scene_section.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

namespace relievo {

namespace {

bool contains(const NumberRange& range, double value) {
  return range.open ? value > range.low && value < range.high : value >= range.low && value <= range.high;
}

/// NaN when it is no number, or beyond the floats that shaders work with.
double number_of(const TomlValue& value) {
  double number = std::numeric_limits<double>::quiet_NaN();
  if (value.kind == TomlValue::Kind::floating) number = value.floating;
  if (value.kind == TomlValue::Kind::integer) number = static_cast<double>(value.integer);
  return std::abs(number) <= std::numeric_limits<float>::max() ? number : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

SceneSection::SceneSection(const TomlValue& table, std::string label, FirstError& errors)
    : table_(&table), reader_(table, std::move(label), errors) {}

void SceneSection::number(std::string_view key, float& value, const NumberRange& range) {
  if (!has(key)) return;
  value = static_cast<float>(reader_.number(key));
  if (contains(range, value)) return;
  reader_.report("scene.range",
                 fmt::format("{} of the {} is {}; {} is expected", quote(key), reader_.label(), value, range.title),
                 key);
}

void SceneSection::integer(std::string_view key, int& value, int minimum, int maximum) {
  if (has(key)) value = reader_.integer(key, minimum, maximum);
}

void SceneSection::numbers(std::string_view key, float* values, std::size_t count, const NumberRange& range) {
  const TomlEntry* entry = find_entry(*table_, key);
  if (entry == nullptr) return;
  const auto report_value = [&](const std::string& given) {
    reader_.report("scene.range",
                   fmt::format("{} of the {} {}; {} numbers, each {}, are expected", quote(key), reader_.label(), given,
                               count, range.title),
                   key);
  };
  if (entry->value.kind != TomlValue::Kind::array) return report_value("is " + describe_value(entry->value));
  if (entry->value.items.size() != count) return report_value(fmt::format("has {} places", entry->value.items.size()));
  for (std::size_t i = 0; i < count; ++i) {
    const double number = number_of(entry->value.items[i]);
    if (!contains(range, number)) return report_value(fmt::format("has {}", describe_value(entry->value.items[i])));
    values[i] = static_cast<float>(number);
  }
}

void SceneSection::path(std::string_view key, const std::filesystem::path& folder, std::filesystem::path& value) {
  value = (folder / reader_.text(key)).lexically_normal();
}

}  // namespace relievo
