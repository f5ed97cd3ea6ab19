/// HTML without surprises: everything that is text passes through `escape`.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "relievo/result.hpp"

namespace relievo::cli {

/// Text as the content of an element or of a quoted attribute.
std::string escape(std::string_view text);

/// A PNG file as a data URI. Errors: "report.picture".
Result<std::string> png_uri(const std::filesystem::path& path);

/// RFC 4648, padded.
std::string base64(std::string_view bytes);

struct Column {
  std::string title;
  bool number = false;  ///< right-aligned
};

/// One cell of text; `mark` is a CSS class of the page, or empty.
struct Cell {
  std::string text, mark = {};
};

/// A table that scrolls by itself where the screen is narrow. Rows have a cell a column.
std::string table(const std::vector<Column>& columns, const std::vector<std::vector<Cell>>& rows);

/// Fixed decimals; "–" for what was not measured (negative seconds, NaN).
std::string fixed(double value, int decimals);

}  // namespace relievo::cli
