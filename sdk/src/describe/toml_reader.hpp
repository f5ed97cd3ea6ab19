/// Reads a table field by field and checks it on the way. The first error of a file is kept and later reads return
/// defaults, so that a descriptor reads as a flat list of its fields, with one check at the end.
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "describe/toml_document.hpp"
#include "relievo/result.hpp"

namespace relievo {

/// The first error of one file.
struct FirstError {
  std::string file;
  std::optional<Error> error;

  void add(std::string id, std::string message, int line, int column);
};

/// `; the nearest is "x"` for the known name nearest to `name`, or `; known are a, b, c` when none is near.
std::string suggest(std::string_view name, const std::vector<std::string>& known);

/// Names of techniques, maps, stages and parameters, [a-z][a-z0-9_]*, become GLSL identifiers: at most 64 bytes, no
/// `__`, no `_` at the end, none of the prefixes gl and relievo. Returns what is wrong, or empty.
std::string name_fault(std::string_view name);

class TomlReader {
 public:
  /// `label` names the table in error sentences: `technique`, `loop "linear_steps"`.
  TomlReader(const TomlValue& table, std::string label, FirstError& errors);

  /// Every key that is not listed is an error; call it first, since a misspelt key explains a missing one.
  void allow_keys(std::initializer_list<std::string_view> keys);

  bool has(std::string_view key) const { return find_entry(table_, key) != nullptr; }

  std::string text(std::string_view key);  ///< required, not blank
  std::string text_or(std::string_view key, std::string_view fallback);
  std::string name(std::string_view key);                ///< required, valid by name_fault()
  std::vector<std::string> names(std::string_view key);  ///< optional; valid names, each once
  /// Optional; each one of `known`, each once. Others are the error `id`.
  std::vector<std::string> choices(std::string_view key, const std::vector<std::string>& known, const std::string& id);
  /// Optional; one word or several, of strings, numbers and booleans (`on`, `off`), each once, none empty.
  std::vector<std::string> words(std::string_view key);
  /// Optional: a table of such words, in the file's order.
  std::vector<std::pair<std::string, std::vector<std::string>>> word_lists(std::string_view key);
  double number(std::string_view key);                          ///< required; integer or float, finite in 32 bits
  int integer(std::string_view key, int minimum, int maximum);  ///< required
  std::vector<int> integers(std::string_view key, int minimum, int maximum);  ///< required; one, or several in an array

  /// A path relative to the file's folder that stays in it; returns it joined to that folder.
  std::string path(std::string_view key);
  std::string path_or_empty(std::string_view key);

  /// One of `known`; its index. Without `fallback` the key is required.
  std::size_t choice(std::string_view key, std::span<const std::string_view> known,
                     std::optional<std::size_t> fallback = {});
  template <class Enum>
  Enum choice_of(std::string_view key, std::span<const std::string_view> known, std::optional<Enum> fallback = {}) {
    std::optional<std::size_t> index;
    if (fallback) index = static_cast<std::size_t>(*fallback);
    return static_cast<Enum>(choice(key, known, index));
  }

  /// The table at `key`, or an empty one that stands where this one does.
  TomlReader table(std::string_view key, std::string label);
  /// The tables below `key` ([loops.x], [loops.y]) by their valid names, in the file's order; none when it is absent.
  std::vector<std::pair<std::string, TomlReader>> named_tables(std::string_view key, std::string_view label);
  /// The tables of an array ([[shader]]), in order. Required, at least one.
  std::vector<TomlReader> table_list(std::string_view key);
  /// The same; none when it is absent.
  std::vector<TomlReader> table_list_or_none(std::string_view key);

  /// Reports an error of this table at the value of `key`, or at the table itself when it is absent.
  void report(std::string id, std::string message, std::string_view key);

  const std::string& label() const { return label_; }
  int line() const { return table_.line; }
  const std::string& file() const { return errors_->file; }

 private:
  struct Fault {
    std::string id, message;
  };
  const TomlEntry* require(std::string_view key);
  std::vector<std::string> strings(std::string_view key, const std::function<Fault(const std::string&)>& fault_of);
  std::optional<std::string> string_of(const TomlEntry& entry);
  std::vector<std::string> words_of(const TomlEntry& entry);
  int integer_of(const TomlEntry& entry, const TomlValue& value, int minimum, int maximum);
  void report_type(const TomlEntry& entry, const TomlValue& value, std::string_view expected);
  void report_at(std::string id, std::string message, const TomlValue& value);

  TomlValue table_;
  std::string label_;
  FirstError* errors_;
};

}  // namespace relievo
