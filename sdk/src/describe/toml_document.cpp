#include "describe/toml_document.hpp"

// Without exceptions a syntax error is a value from the start.
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#include <fmt/format.h>
// Its assertions hold users to TOML; what they guard is reported as an error right after.
#define TOML_ASSERT(expression) static_cast<void>(0)
#include <toml++/toml.h>

#include <algorithm>
#include <tuple>

#include "describe/toml_guard.hpp"

namespace relievo {
namespace {

constexpr std::size_t max_document_size = 1 << 20;

template <class Target>
void set_place(Target& target, const toml::source_position& position) {
  target.line = std::max(1, static_cast<int>(position.line));
  target.column = std::max(1, static_cast<int>(position.column));
}

TomlValue convert(const toml::node& node);

void convert_table(const toml::table& table, TomlValue& value) {
  for (const auto& [key, node] : table) {
    TomlEntry entry;
    entry.key = key.str();
    entry.value = convert(node);
    set_place(entry, key.source().begin);
    value.entries.push_back(std::move(entry));
  }
  const auto place = [](const TomlEntry& entry) { return std::tie(entry.line, entry.column); };
  std::sort(value.entries.begin(), value.entries.end(),
            [&](const TomlEntry& a, const TomlEntry& b) { return place(a) < place(b); });
}

TomlValue convert(const toml::node& node) {
  TomlValue value;
  set_place(value, node.source().begin);
  switch (node.type()) {
    case toml::node_type::string:
      value.kind = TomlValue::Kind::string;
      value.string = node.as_string()->get();
      break;
    case toml::node_type::integer:
      value.kind = TomlValue::Kind::integer;
      value.integer = node.as_integer()->get();
      break;
    case toml::node_type::floating_point:
      value.kind = TomlValue::Kind::floating;
      value.floating = node.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      value.kind = TomlValue::Kind::boolean;
      value.boolean = node.as_boolean()->get();
      break;
    case toml::node_type::array:
      value.kind = TomlValue::Kind::array;
      for (const toml::node& item : *node.as_array()) value.items.push_back(convert(item));
      break;
    case toml::node_type::table:
      convert_table(*node.as_table(), value);
      break;
    default:
      value.kind = TomlValue::Kind::date_time;
  }
  return value;
}

/// The longest start of `text` of at most `length` bytes that does not cut a UTF-8 sequence.
std::string_view cut(std::string_view text, std::size_t length) {
  if (text.size() <= length) return text;
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
  return text.substr(0, length);
}

std::string quote_start(std::string_view text, std::size_t length) {
  const std::string_view shown = cut(text, length);
  std::string result = "\"";
  for (const char c : shown) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      result += fmt::format("\\x{:02x}", byte);
    } else {
      result += c;
    }
  }
  if (shown.size() < text.size()) result += "…";
  return result + "\"";
}

}  // namespace

const TomlEntry* find_entry(const TomlValue& table, std::string_view key) {
  for (const TomlEntry& entry : table.entries) {
    if (entry.key == key) return &entry;
  }
  return nullptr;
}

std::string quote(std::string_view text) {
  return quote_start(text, 60);
}

std::string quote_path(std::string_view path) {
  return quote_start(path, 1000);
}

std::string describe_value(const TomlValue& value) {
  switch (value.kind) {
    case TomlValue::Kind::string:
      return "the string " + quote(value.string);
    case TomlValue::Kind::integer:
      return fmt::format("the integer {}", value.integer);
    case TomlValue::Kind::floating:
      return fmt::format("the float {}", value.floating);
    case TomlValue::Kind::boolean:
      return value.boolean ? "the boolean true" : "the boolean false";
    case TomlValue::Kind::date_time:
      return "a date or time";
    case TomlValue::Kind::array:
      return "an array";
    case TomlValue::Kind::table:
      return "a table";
  }
  return "a value";
}

Result<TomlValue> parse_toml(std::string_view text, const std::string& file) {
  if (text.size() > max_document_size) {
    return fail(ErrorCode::descriptor, "describe.syntax",
                fmt::format("the file is {} bytes long; at most {} are allowed", text.size(), max_document_size), file,
                1, 1);
  }
  if (const Status guarded = guard_toml(text, file); !guarded) return tl::unexpected(guarded.error());
  const toml::parse_result parsed = toml::parse(text, std::string_view(file));
  if (parsed) return convert(parsed.table());
  Error error{ErrorCode::descriptor, "describe.syntax", std::string(parsed.error().description()), file, 1, 1};
  set_place(error, parsed.error().source().begin);
  return tl::unexpected(std::move(error));
}

}  // namespace relievo
