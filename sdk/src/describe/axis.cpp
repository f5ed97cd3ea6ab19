#include "describe/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "describe/descriptor_fields.hpp"
#include "describe/rules.hpp"

namespace relievo {

namespace {

std::size_t index_of(const std::vector<std::string>& names, std::string_view name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// `{height = ["normal"]}` by the index of the value.
std::vector<std::vector<std::string>> read_needs(TomlReader& table, std::string_view key, const Parameter& axis) {
  std::vector<std::vector<std::string>> needs(axis.choices.size());
  for (auto& [value, words] : table.word_lists(key)) {
    const std::size_t index = index_of(axis.choices, value);
    if (index == axis.choices.size()) {
      table.report("describe.range",
                   fmt::format("{} of the {} names the value {}, which it does not have{}", quote(key), table.label(),
                               quote(value), suggest(value, axis.choices)),
                   key);
      continue;
    }
    needs[index] = std::move(words);
  }
  return needs;
}

void read_features_of_values(TomlReader& table, Parameter& axis) {
  const FeatureSet& known = known_features();
  for (std::vector<std::string>& words : read_needs(table, "features", axis)) {
    for (const std::string& word : words) {
      if (known.contains(word)) continue;
      table.report("describe.unknown-feature",
                   fmt::format("\"features\" of the {} has {}, which is not known{}", table.label(), quote(word),
                               suggest(word, {known.begin(), known.end()})),
                   "features");
    }
    axis.features.emplace_back(words.begin(), words.end());
  }
}

std::optional<double> read_value(TomlReader& table, std::string_view key, const Parameter& axis) {
  const std::string text = table.text(key);
  const std::size_t index = index_of(axis.choices, text);
  if (index < axis.choices.size()) return static_cast<double>(index);
  table.report("describe.range",
               fmt::format("\"{}\" of the {} is {}; one of its values is expected{}", key, table.label(), quote(text),
                           suggest(text, axis.choices)),
               key);
  return std::nullopt;
}

void read_axis_rules(TomlReader& table, const std::string& owner, Parameter& axis) {
  for (TomlReader& rule : table.table_list_or_none("rule")) {
    rule.allow_keys({"values", "requires", "excludes", "reason"});
    const std::vector<std::string> values = rule.choices("values", axis.choices, "describe.range");
    const Condition when = {owner + "." + axis.name, values.empty() ? axis.choices : values};
    for (Rule& one : read_rules(rule, {when}, owner)) axis.rules.push_back(std::move(one));
  }
}

void read_bindings(TomlReader& table, Parameter& axis) {
  const std::vector<std::string> known(binding_names.begin(), binding_names.end());
  for (const std::string& name : table.choices("bindings", known, "describe.range")) {
    axis.bindings.push_back(static_cast<BindingTime>(index_of(known, name)));
  }
  if (axis.bindings.empty() ||
      std::find(axis.bindings.begin(), axis.bindings.end(), axis.binding) != axis.bindings.end())
    return;
  table.report("describe.range",
               fmt::format("\"binding\" of the {} is {}, which its \"bindings\" leave out", table.label(),
                           quote(to_string(axis.binding))),
               "binding");
}

tl::unexpected<Error> bad_value(const Parameter& parameter, std::string_view text, const std::string& expected) {
  return fail(ErrorCode::usage, "describe.value",
              fmt::format("the value of {} is {}; {} is expected", quote(parameter.name), quote(text), expected));
}

}  // namespace

void read_axis(TomlReader& table, const std::string& owner, Parameter& axis) {
  axis.is_integer = true;
  axis.choices = table.names("values");
  if (axis.choices.size() < 2) {
    table.report(
        "describe.range",
        fmt::format("\"values\" of the {} has {}; two or more are expected", table.label(), axis.choices.size()),
        "values");
  }
  axis.maximum = std::max(0.0, static_cast<double>(axis.choices.size()) - 1);
  axis.value = read_value(table, "default", axis).value_or(0);
  if (table.has("software")) axis.software_value = read_value(table, "software", axis);
  read_bindings(table, axis);
  axis.maps = read_needs(table, "maps", axis);
  read_features_of_values(table, axis);
  read_axis_rules(table, owner, axis);
}

Result<double> parse_value(const Parameter& parameter, std::string_view text) {
  if (!parameter.choices.empty()) {
    const std::size_t index = index_of(parameter.choices, text);
    if (index < parameter.choices.size()) return static_cast<double>(index);
    return bad_value(parameter, text, fmt::format("one of {}", fmt::join(parameter.choices, ", ")));
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size()) return value;
  return bad_value(parameter, text, parameter.is_integer ? "a whole number" : "a number");
}

std::string value_text(const Parameter& parameter, double value) {
  const auto index = static_cast<std::size_t>(std::max(value, 0.0));
  if (index < parameter.choices.size()) return parameter.choices[index];
  return fmt::format("{}", value);
}

}  // namespace relievo
