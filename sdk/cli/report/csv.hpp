/// Fields of CSV files (RFC 4180).
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace relievo::cli {

/// Quoted where it must be.
inline std::string csv_field(std::string text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 2)) text.insert(at, "\"");
  return '"' + text + '"';
}

/// Empty for what was not measured: a negative number, or NaN.
inline std::string csv_number(double value) {
  return std::isnan(value) || value < 0 ? "" : fmt::format("{:.6g}", value);
}

}  // namespace relievo::cli
