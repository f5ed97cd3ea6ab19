#include "describe/descriptor_place.hpp"

#include "describe/toml_document.hpp"

namespace relievo {

Place find_place(std::string_view text, std::string_view key, std::string_view item) {
  const Result<TomlValue> document = parse_toml(text, "");
  const TomlEntry* entry = document ? find_entry(*document, key) : nullptr;
  if (!entry) return {};
  for (const TomlValue& value : entry->value.items) {
    if (!item.empty() && value.string == item) return {value.line, value.column};
  }
  return {entry->value.line, entry->value.column};
}

}  // namespace relievo
