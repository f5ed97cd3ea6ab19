/// Errors as values: what a user can cause comes back as `Result<T>`; only broken contracts of our own assert.
///
/// Threads. "Thread-safe" at a function means that any number of threads may call it at once, also with the same
/// arguments where it does not change them; what it changes or moves from is the caller's to keep others from. Of a
/// plain struct the same holds: any number may read one that nobody writes. No function keeps anything of a call but
/// `use_program_cache`; no function may be called by a signal handler. Every function of this header is thread-safe.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace relievo {

/// What went wrong, coarsely; decides the command line's exit code.
enum class ErrorCode {
  usage,        ///< a wrong argument or option: exit 1
  io,           ///< a file that cannot be read, understood or written: exit 1
  descriptor,   ///< a technique.toml, map.toml, stage.toml or scene that does not validate: exit 1
  compile,      ///< composing or compiling a shader failed: exit 2
  unsupported,  ///< the target, backend or driver cannot do it: exit 3
  mismatch,     ///< results disagree: exit 4
  backend,      ///< a graphics API call failed: exit 1
};

/// One error. `id` is a stable identifier that tests and scripts can match, such as "describe.unknown-key".
/// `message` is one sentence in the present tense with the given and the expected value.
struct Error {
  ErrorCode code = ErrorCode::usage;
  std::string id;
  std::string message;
  std::string file;  ///< the author's file, or empty
  int line = 0;      ///< 1-based; 0 = unknown
  int column = 0;    ///< 1-based; 0 = unknown
};

template <class T>
using Result = tl::expected<T, Error>;
using Status = tl::expected<void, Error>;

/// Shorthand for returning an error: `return fail(ErrorCode::io, "image.missing", "…", path);`
inline tl::unexpected<Error> fail(ErrorCode code, std::string id, std::string message, std::string file = {},
                                  int line = 0, int column = 0) {
  return tl::unexpected<Error>(Error{code, std::move(id), std::move(message), std::move(file), line, column});
}

/// Returns the process exit code for an error: 1 usage or I/O, 2 compile, 3 unsupported, 4 mismatch.
int exit_code(ErrorCode code);

/// Formats as gcc does: `file:line:column: error: message [id]`; parts that are unknown are left out.
std::string format(const Error& error);

}  // namespace relievo
