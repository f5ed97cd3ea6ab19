/// A look at a TOML text before it is parsed, for what toml++ 3.3 does not survive: it recurses once a level and bounds
/// neither dotted keys nor its destructor, so that `a.a.a.…` overflows the stack.
#pragma once

#include <string>
#include <string_view>

#include "relievo/result.hpp"

namespace relievo {

/// Errors: "describe.syntax" where a dotted key has more than 16 parts or brackets nest more than 16 deep.
Status guard_toml(std::string_view text, const std::string& file);

}  // namespace relievo
