#include "report/html.hpp"

#include <fmt/format.h>
#include <cmath>
#include <fstream>
#include <iterator>

namespace relievo::cli {

std::string escape(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u;
  };
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    result += digits[word >> 18];
    result += digits[word >> 12 & 63];
    result += i + 1 < bytes.size() ? digits[word >> 6 & 63] : '=';
    result += i + 2 < bytes.size() ? digits[word & 63] : '=';
  }
  return result;
}

Result<std::string> png_uri(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file || bytes.empty()) {
    return fail(ErrorCode::io, "report.picture", fmt::format("'{}' cannot be read back", path.filename().string()),
                path.string());
  }
  return "data:image/png;base64," + base64(bytes);
}

std::string table(const std::vector<Column>& columns, const std::vector<std::vector<Cell>>& rows) {
  auto open = [&](const char* tag, std::size_t column, const std::string& mark) {
    std::string classes = columns[column].number ? "n" : "";
    if (!mark.empty()) classes += (classes.empty() ? "" : " ") + mark;
    return classes.empty() ? fmt::format("<{}>", tag) : fmt::format("<{} class=\"{}\">", tag, escape(classes));
  };
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (std::size_t i = 0; i < columns.size(); ++i) html += open("th", i, "") + escape(columns[i].title) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const std::vector<Cell>& row : rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) html += open("td", i, row[i].mark) + escape(row[i].text) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string fixed(double value, int decimals) {
  return std::isfinite(value) && value >= 0 ? fmt::format("{:.{}f}", value, decimals) : "–";
}

}  // namespace relievo::cli
