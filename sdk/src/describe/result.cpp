#include "relievo/result.hpp"

#include <fmt/format.h>

namespace relievo {

int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::compile:
      return 2;
    case ErrorCode::unsupported:
      return 3;
    case ErrorCode::mismatch:
      return 4;
    default:
      return 1;
  }
}

std::string format(const Error& error) {
  std::string place;
  if (!error.file.empty()) {
    place = error.file;
    if (error.line > 0) place += fmt::format(":{}", error.line);
    if (error.line > 0 && error.column > 0) place += fmt::format(":{}", error.column);
    place += ": ";
  }
  return fmt::format("{}error: {} [{}]", place, error.message, error.id);
}

}  // namespace relievo
