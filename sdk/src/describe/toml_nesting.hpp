/// A look at a TOML text before it is parsed: toml++ recurses once a level of nesting, and its 3.3 bounds neither
/// dotted keys nor the destructor, so that `a.a.a.…` of a megabyte would overflow the stack.
#pragma once

#include <string>
#include <string_view>

#include "relievo/result.hpp"

namespace relievo {

/// Errors: "describe.syntax" where a dotted key has more than 16 parts, or brackets nest more than 16 deep.
Status check_toml_nesting(std::string_view text, const std::string& file);

}  // namespace relievo
