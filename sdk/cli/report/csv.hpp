#pragma once

#include <string>

namespace relievo::cli {

/// One field of a CSV file (RFC 4180): quoted where it must be.
inline std::string csv_field(std::string text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2)) text.insert(at, "\"");
  return '"' + text + '"';
}

}  // namespace relievo::cli
