/// A bound on expressions, before the compilers see them.
#pragma once

#include <string_view>

namespace relievo {

/// glslang, SPIRV-Tools and SPIRV-Cross descend recursively into expressions; at about 15 000 chained operators an 8
/// MiB stack runs out. Hand-written shaders stay below a hundred.
constexpr int kMaxChainedOperators = 4000;

/// Whether some expression of `source` chains more operators than that at one level of parentheses. Comments and
/// preprocessor lines do not count; what macros expand to is not seen.
bool has_runaway_expression(std::string_view source);

}  // namespace relievo
