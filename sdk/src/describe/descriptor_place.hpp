/// Where a value stands in a descriptor that parsed well: looked up again only when a check across files fails, so that
/// descriptors themselves stay plain.
#pragma once

#include <string_view>

namespace relievo {

struct Place {
  int line = 1, column = 1;
};

/// The place of `key` at the top of the descriptor, or of `item` in its array; the file's start when it is not found.
Place find_place(std::string_view text, std::string_view key, std::string_view item = {});

}  // namespace relievo
