#include "permute/archive/naming.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace relievo::archive {

namespace {

void append(std::string& name, std::string_view axis, std::string_view value) {
  if (!name.empty()) name += ' ';
  name.append(axis).append("=").append(value);
}

/// The first name that comes twice, or null.
const std::string* repeated(std::vector<const std::string*> names) {
  std::sort(names.begin(), names.end(), [](const auto* a, const auto* b) { return *a < *b; });
  const auto twin =
      std::adjacent_find(names.begin(), names.end(), [](const auto* a, const auto* b) { return *a == *b; });
  return twin == names.end() ? nullptr : *twin;
}

std::string fault_of(const ArchiveAxis& axis) {
  if (axis.name.empty()) return "an axis has no name";
  if (axis.name.find('=') != std::string::npos) return fmt::format("the name of axis '{}' has an '='", axis.name);
  if (axis.values.empty() || axis.values.size() >= kNoValue) {
    return fmt::format("axis '{}' has {} values; expected 1 to 65534", axis.name, axis.values.size());
  }
  if (axis.default_value >= axis.values.size()) {
    return fmt::format("the default of axis '{}' is value {}; it has {}", axis.name, axis.default_value,
                       axis.values.size());
  }
  std::vector<const std::string*> values;
  for (const std::string& value : axis.values) values.push_back(&value);
  const std::string* twin = repeated(std::move(values));
  return twin == nullptr ? std::string() : fmt::format("axis '{}' has the value '{}' twice", axis.name, *twin);
}

}  // namespace

std::string name_of(std::span<const ArchiveAxis> axes, std::span<const std::uint16_t> values) {
  std::string name;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (values[i] != kNoValue && values[i] != axes[i].default_value)
      append(name, axes[i].name, axes[i].values[values[i]]);
  }
  return name.empty() ? "(every axis at its default)" : name;
}

std::string full_name_of(std::span<const ArchiveAxis> axes, std::span<const std::uint16_t> values) {
  std::string name;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    append(name, axes[i].name, values[i] == kNoValue ? "(none)" : std::string_view(axes[i].values[values[i]]));
  }
  return name.empty() ? "(no axes)" : name;
}

ValueKeys::ValueKeys(std::span<const ArchiveAxis> axes) {
  for (const ArchiveAxis& axis : axes) {
    firsts_.push_back(static_cast<std::uint32_t>(keys_.size()));
    for (const std::string& value : axis.values) keys_.push_back(axis_key(axis.name, value));
    keys_[firsts_.back() + axis.default_value] = 0;
  }
}

std::uint64_t ValueKeys::key(std::span<const std::uint16_t> values) const {
  std::uint64_t key = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] != kNoValue) key += keys_[firsts_[i] + values[i]];
  }
  return key;
}

std::string fault_of(std::span<const ArchiveAxis> axes) {
  std::vector<const std::string*> names;
  for (const ArchiveAxis& axis : axes) {
    if (std::string fault = fault_of(axis); !fault.empty()) return fault;
    names.push_back(&axis.name);
  }
  const std::string* twin = repeated(std::move(names));
  return twin == nullptr ? std::string() : fmt::format("there are two axes '{}'", *twin);
}

bool in_range(std::span<const ArchiveAxis> axes, std::span<const std::uint16_t> values) {
  if (values.size() != axes.size()) return false;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (values[i] != kNoValue && values[i] >= axes[i].values.size()) return false;
  }
  return true;
}

}  // namespace relievo::archive
