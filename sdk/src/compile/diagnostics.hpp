/// glslang's log as an Error that names the author's file and line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "relievo/result.hpp"

namespace relievo {

struct Diagnostic {
  std::string file;  ///< empty: the log names none
  int line = 0;
  std::string message;
};

/// The errors of a glslang log in order; lines that only count or end the compilation are left out.
std::vector<Diagnostic> parse_glslang_log(std::string_view log);

/// One Error, id "compile.glsl": file and line of the first diagnostic that has them, a message that names the
/// permutation and lists every diagnostic (at most 10).
Error glsl_error(std::string_view log, std::string_view permutation_key);

/// glslang gives no columns: the place, in the line that `error` names, of the token that its message names first, or
/// else of the line's first character; 0 when `text` (with its #line directives) has no such line.
int find_column(std::string_view text, const Error& error);

}  // namespace relievo
