/// What the answers of the descriptor parsers must keep, whatever the text.
#pragma once

#include <string>
#include <string_view>

#include "relievo/describe.hpp"

namespace relievo::test {

/// What is wrong with a parser's answer, or empty.
template <class Descriptor>
std::string fault_of(const Result<Descriptor>& result, const std::string& path) {
  if (!result) {
    const Error& error = result.error();
    if (error.line < 1 || error.column < 1) return "the error has no place";
    if (error.file != path) return "the error names another file";
    if (!error.id.starts_with("describe.") || error.message.empty()) return "the error says nothing";
    return {};
  }
  if (result->name.empty() || result->title.empty()) return "a name is empty";
  for (const Parameter& parameter : result->parameters) {
    const bool in_order = parameter.minimum <= parameter.value && parameter.value <= parameter.maximum;
    if (!in_order) return "a default is out of range";
    if (parameter.is_loop && parameter.minimum < 0) return "a loop runs less than 0 times";
  }
  return {};
}

/// Of all three parsers.
inline std::string fault_of_all(std::string_view text) {
  const std::string path = "f.toml";
  for (const std::string& fault : {fault_of(parse_technique(text, path), path), fault_of(parse_map(text, path), path),
                                   fault_of(parse_stage(text, path), path)}) {
    if (!fault.empty()) return fault;
  }
  return {};
}

}  // namespace relievo::test
