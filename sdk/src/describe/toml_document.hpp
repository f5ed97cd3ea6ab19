/// A TOML file as plain values that know where they stand. Only toml_document.cpp sees toml++.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/result.hpp"

namespace relievo {

struct TomlEntry;

/// One value; the member that `kind` names is the one that counts. Lines and columns are 1-based.
struct TomlValue {
  enum class Kind { string, integer, floating, boolean, date_time, array, table };
  Kind kind = Kind::table;
  std::string string;
  std::int64_t integer = 0;
  double floating = 0;
  bool boolean = false;
  std::vector<TomlValue> items;    ///< array
  std::vector<TomlEntry> entries;  ///< table, in the file's order
  int line = 1, column = 1;
};

struct TomlEntry {
  std::string key;
  TomlValue value;
  int line = 1, column = 1;  ///< of the key
};

/// The entry of a table with that key, or null.
const TomlEntry* find_entry(const TomlValue& table, std::string_view key);

/// For error sentences: `the string "abc"`, `the integer 7`, `a table`. Long strings are cut, control characters
/// escaped.
std::string describe_value(const TomlValue& value);

/// The text between quotes, at most about 60 bytes of it, control characters escaped.
std::string quote(std::string_view text);
/// The same for a path, which is worth showing whole: up to 1000 bytes.
std::string quote_path(std::string_view path);

/// Parses `text`; the result is its root table. Errors: "describe.syntax" with the place in `file` where TOML's grammar
/// is broken, where keys or values nest deeper than any descriptor needs, or when the text exceeds 1 MiB.
Result<TomlValue> parse_toml(std::string_view text, const std::string& file);

}  // namespace relievo
