/// A look at a TOML text before it is parsed, for what toml++ 3.3 does not survive:
/// - it recurses once a level and bounds neither dotted keys nor its destructor, so that `a.a.a.…` overflows the stack;
/// - its test for whitespace is undefined for most characters outside ASCII. Outside strings and comments TOML has
///   none, unless quotes follow a value's characters; inside, the test is made after a backslash.
#pragma once

#include <string>
#include <string_view>

#include "relievo/result.hpp"

namespace relievo {

/// Errors: "describe.syntax" where a dotted key has more than 16 parts, brackets nest more than 16 deep, a character
/// outside ASCII stands outside strings and comments, or in quotes right behind another character (`1"\u00a7`), or
/// follows a backslash and whitespace.
Status guard_toml(std::string_view text, const std::string& file);

}  // namespace relievo
