#include "describe/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "describe/source_path.hpp"
#include "relievo/describe.hpp"

namespace relievo {

void FirstError::add(std::string id, std::string message, int line, int column) {
  if (error) return;
  error = Error{ErrorCode::descriptor, std::move(id), std::move(message), file, line, column};
}

std::string suggest(std::string_view name, const std::vector<std::string>& known) {
  if (known.empty()) return "; none is known";
  const std::string nearest = nearest_name(name, known);
  if (!nearest.empty()) return fmt::format("; the nearest is {}", quote_path(nearest));
  return fmt::format("; known are {}", fmt::join(known, ", "));
}

std::string name_fault(std::string_view name) {
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_allowed = [&](char c) { return is_lower(c) || (c >= '0' && c <= '9') || c == '_'; };
  if (name.empty() || !is_lower(name[0]) || !std::all_of(name.begin(), name.end(), is_allowed)) {
    return "a name matches [a-z][a-z0-9_]*";
  }
  if (name.size() > 64) return "a name has at most 64 characters";
  if (name.back() == '_' || name.find("__") != name.npos) {
    return "a name has no \"__\" and no \"_\" at its end, which GLSL reserves once it is a prefix";
  }
  for (const std::string_view prefix : {"gl", "relievo"}) {
    if (name == prefix || (name.starts_with(prefix) && name[prefix.size()] == '_')) {
      return fmt::format("the prefix {} is reserved", quote(prefix));
    }
  }
  return {};
}

TomlReader::TomlReader(const TomlValue& table, std::string label, FirstError& errors)
    : table_(table), label_(std::move(label)), errors_(&errors) {}

void TomlReader::report_at(std::string id, std::string message, const TomlValue& value) {
  errors_->add(std::move(id), std::move(message), value.line, value.column);
}

void TomlReader::report(std::string id, std::string message, std::string_view key) {
  const TomlEntry* entry = find_entry(table_, key);
  report_at(std::move(id), std::move(message), entry ? entry->value : table_);
}

void TomlReader::report_type(const TomlEntry& entry, const TomlValue& value, std::string_view expected) {
  report_at(
      "describe.type",
      fmt::format("{} of the {} is {}; {} is expected", quote(entry.key), label_, describe_value(value), expected),
      value);
}

void TomlReader::allow_keys(std::initializer_list<std::string_view> keys) {
  for (const TomlEntry& entry : table_.entries) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    const std::vector<std::string> known(keys.begin(), keys.end());
    errors_->add("describe.unknown-key",
                 fmt::format("the {} has the unknown key {}{}", label_, quote(entry.key), suggest(entry.key, known)),
                 entry.line, entry.column);
    return;
  }
}

const TomlEntry* TomlReader::require(std::string_view key) {
  const TomlEntry* entry = find_entry(table_, key);
  if (!entry) report_at("describe.missing-key", fmt::format("the {} lacks the key {}", label_, quote(key)), table_);
  return entry;
}

std::optional<std::string> TomlReader::string_of(const TomlEntry& entry) {
  if (entry.value.kind == TomlValue::Kind::string) return entry.value.string;
  report_type(entry, entry.value, "a string");
  return {};
}

std::string TomlReader::text(std::string_view key) {
  const TomlEntry* entry = require(key);
  if (!entry) return {};
  std::string value = string_of(*entry).value_or("?");
  if (value.find_first_not_of(" \t\r\n") == value.npos) {
    report_at("describe.missing-key", fmt::format("{} of the {} is empty; a text is expected", quote(key), label_),
              entry->value);
  }
  return value;
}

std::string TomlReader::text_or(std::string_view key, std::string_view fallback) {
  const TomlEntry* entry = find_entry(table_, key);
  return std::string(entry ? string_of(*entry).value_or("") : fallback);
}

std::string TomlReader::name(std::string_view key) {
  const TomlEntry* entry = require(key);
  const std::optional<std::string> value = entry ? string_of(*entry) : std::nullopt;
  if (!value) return {};
  const std::string fault = name_fault(*value);
  if (!fault.empty()) {
    report("describe.name", fmt::format("{} of the {} is {}; {}", quote(key), label_, quote(*value), fault), key);
  }
  return *value;
}

std::vector<std::string> TomlReader::strings(std::string_view key,
                                             const std::function<Fault(const std::string&)>& fault_of) {
  std::vector<std::string> result;
  const TomlEntry* entry = find_entry(table_, key);
  if (!entry) return result;
  if (entry->value.kind != TomlValue::Kind::array) report_type(*entry, entry->value, "an array of strings");
  for (const TomlValue& item : entry->value.items) {
    if (item.kind != TomlValue::Kind::string) {
      report_type(*entry, item, "a string in each place");
      continue;
    }
    if (const Fault fault = fault_of(item.string); !fault.id.empty()) {
      report_at(fault.id, fmt::format("{} of the {} has {}{}", quote(key), label_, quote(item.string), fault.message),
                item);
    } else if (std::find(result.begin(), result.end(), item.string) != result.end()) {
      report_at("describe.duplicate",
                fmt::format("{} of the {} has {} twice; once is expected", quote(key), label_, quote(item.string)),
                item);
    }
    result.push_back(item.string);
  }
  return result;
}

std::vector<std::string> TomlReader::names(std::string_view key) {
  return strings(key, [](const std::string& name) {
    const std::string fault = name_fault(name);
    return fault.empty() ? Fault{} : Fault{"describe.name", "; " + fault};
  });
}

std::vector<std::string> TomlReader::choices(std::string_view key, const std::vector<std::string>& known,
                                             const std::string& id) {
  return strings(key, [&](const std::string& name) {
    const bool is_known = std::find(known.begin(), known.end(), name) != known.end();
    return is_known ? Fault{} : Fault{id, ", which is not known" + suggest(name, known)};
  });
}

namespace {

/// As a user would type the value after `--set`; nothing for what is no single value.
std::optional<std::string> word_of(const TomlValue& value) {
  switch (value.kind) {
    case TomlValue::Kind::string:
      return value.string.empty() ? std::nullopt : std::optional(value.string);
    case TomlValue::Kind::integer:
      return fmt::format("{}", value.integer);
    case TomlValue::Kind::floating:
      return fmt::format("{}", value.floating);
    case TomlValue::Kind::boolean:
      return value.boolean ? "on" : "off";
    default:
      return std::nullopt;
  }
}

}  // namespace

std::vector<std::string> TomlReader::words_of(const TomlEntry& entry) {
  const bool is_list = entry.value.kind == TomlValue::Kind::array;
  if (is_list && entry.value.items.empty()) report_type(entry, entry.value, "at least one word");
  std::vector<std::string> words;
  for (const TomlValue& item : is_list ? entry.value.items : std::vector<TomlValue>{entry.value}) {
    const std::optional<std::string> word = word_of(item);
    if (!word) {
      report_type(entry, item, "a word, a number or a boolean, or several in an array");
    } else if (std::find(words.begin(), words.end(), *word) != words.end()) {
      report_at("describe.duplicate",
                fmt::format("{} of the {} has {} twice; once is expected", quote(entry.key), label_, quote(*word)),
                item);
    } else {
      words.push_back(*word);
    }
  }
  return words;
}

std::vector<std::string> TomlReader::words(std::string_view key) {
  const TomlEntry* entry = find_entry(table_, key);
  return entry ? words_of(*entry) : std::vector<std::string>();
}

std::vector<std::pair<std::string, std::vector<std::string>>> TomlReader::word_lists(std::string_view key) {
  std::vector<std::pair<std::string, std::vector<std::string>>> lists;
  const TomlEntry* entry = find_entry(table_, key);
  if (!entry) return lists;
  if (entry->value.kind != TomlValue::Kind::table) report_type(*entry, entry->value, "a table of words by name");
  for (const TomlEntry& list : entry->value.entries) lists.emplace_back(list.key, words_of(list));
  return lists;
}

double TomlReader::number(std::string_view key) {
  const TomlEntry* entry = require(key);
  if (!entry) return 0;
  double value = entry->value.floating;
  if (entry->value.kind == TomlValue::Kind::integer) {
    value = static_cast<double>(entry->value.integer);
  } else if (entry->value.kind != TomlValue::Kind::floating) {
    report_type(*entry, entry->value, "a number");
    return 0;
  }
  // Shaders hold it in 32 bits.
  if (std::isfinite(value) && std::abs(value) <= std::numeric_limits<float>::max()) return value;
  report("describe.range",
         fmt::format("{} of the {} is {}; a finite 32-bit number is expected", quote(key), label_, value), key);
  return 0;
}

int TomlReader::integer_of(const TomlEntry& entry, const TomlValue& value, int minimum, int maximum) {
  if (value.kind != TomlValue::Kind::integer) {
    report_type(entry, value, "an integer");
    return minimum;
  }
  if (value.integer >= minimum && value.integer <= maximum) return static_cast<int>(value.integer);
  report_at("describe.range",
            fmt::format("{} of the {} is {}; an integer from {} to {} is expected", quote(entry.key), label_,
                        value.integer, minimum, maximum),
            value);
  return minimum;
}

int TomlReader::integer(std::string_view key, int minimum, int maximum) {
  const TomlEntry* entry = require(key);
  return entry ? integer_of(*entry, entry->value, minimum, maximum) : minimum;
}

std::vector<int> TomlReader::integers(std::string_view key, int minimum, int maximum) {
  const TomlEntry* entry = require(key);
  if (!entry) return {};
  if (entry->value.kind != TomlValue::Kind::array) return {integer_of(*entry, entry->value, minimum, maximum)};
  if (entry->value.items.empty()) report_type(*entry, entry->value, "at least one integer");
  std::vector<int> integers;
  for (const TomlValue& item : entry->value.items) integers.push_back(integer_of(*entry, item, minimum, maximum));
  return integers;
}

std::string TomlReader::path(std::string_view key) {
  const TomlEntry* entry = require(key);
  const std::optional<std::string> value = entry ? string_of(*entry) : std::nullopt;
  if (!value) return {};
  std::string joined = join_source_path(folder_of(file()), *value);
  if (joined.empty()) {
    report(
        "describe.escapes-folder",
        fmt::format("{} of the {} is {}; a file below the folder of the descriptor is expected, with / between folders",
                    quote(key), label_, quote(*value)),
        key);
  }
  return joined;
}

std::string TomlReader::path_or_empty(std::string_view key) {
  return has(key) ? path(key) : std::string();
}

std::size_t TomlReader::choice(std::string_view key, std::span<const std::string_view> known,
                               std::optional<std::size_t> fallback) {
  if (fallback && !has(key)) return *fallback;
  const TomlEntry* entry = require(key);
  const std::optional<std::string> value = entry ? string_of(*entry) : std::nullopt;
  if (!value) return 0;
  const auto found = std::find(known.begin(), known.end(), *value);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  report("describe.range",
         fmt::format("{} of the {} is {}, which is not known{}", quote(key), label_, quote(*value),
                     suggest(*value, {known.begin(), known.end()})),
         key);
  return 0;
}

TomlReader TomlReader::table(std::string_view key, std::string label) {
  TomlValue empty;
  empty.line = table_.line;
  empty.column = table_.column;
  const TomlEntry* entry = require(key);
  if (!entry) return {empty, std::move(label), *errors_};
  if (entry->value.kind != TomlValue::Kind::table) report_type(*entry, entry->value, "a table");
  return {entry->value, std::move(label), *errors_};
}

std::vector<std::pair<std::string, TomlReader>> TomlReader::named_tables(std::string_view key, std::string_view label) {
  std::vector<std::pair<std::string, TomlReader>> result;
  const TomlEntry* entry = find_entry(table_, key);
  if (!entry) return result;
  if (entry->value.kind != TomlValue::Kind::table) report_type(*entry, entry->value, "tables by name");
  for (const TomlEntry& named : entry->value.entries) {
    if (named.value.kind != TomlValue::Kind::table) {
      report_type(named, named.value, fmt::format("the table of a {}", label));
      continue;
    }
    if (const std::string fault = name_fault(named.key); !fault.empty()) {
      errors_->add("describe.name", fmt::format("the {} has the name {}; {}", label, quote(named.key), fault),
                   named.line, named.column);
    }
    result.emplace_back(named.key, TomlReader(named.value, fmt::format("{} {}", label, quote(named.key)), *errors_));
  }
  return result;
}

std::vector<TomlReader> TomlReader::table_list_or_none(std::string_view key) {
  return has(key) ? table_list(key) : std::vector<TomlReader>();
}

std::vector<TomlReader> TomlReader::table_list(std::string_view key) {
  std::vector<TomlReader> result;
  const TomlEntry* entry = require(key);
  if (!entry) return result;
  if (entry->value.kind != TomlValue::Kind::array || entry->value.items.empty()) {
    report_type(*entry, entry->value, fmt::format("one or more [[{}]]", key));
  }
  for (const TomlValue& item : entry->value.items) {
    if (item.kind != TomlValue::Kind::table) {
      report_type(*entry, item, fmt::format("[[{}]]", key));
      continue;
    }
    result.emplace_back(item, fmt::format("{} {}", key, result.size() + 1), *errors_);
  }
  return result;
}

}  // namespace relievo
