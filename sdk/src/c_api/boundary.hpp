/// What every function of the C API does at its ends: arguments are checked, and nothing but a status leaves.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "relievo.h"
#include "relievo/result.hpp"

namespace relievo::c_api {

/// Writes the error where there is room for it. Allocates nothing.
relievo_status write_error(relievo_status code, std::string_view id, std::string_view message, std::string_view file,
                           int line, int column, relievo_error* error) noexcept;
relievo_status write_error(const Error& failure, relievo_error* error) noexcept;
/// In a handler: of the exception that is in flight.
relievo_status write_exception(relievo_error* error) noexcept;

/// Runs a function's body, which returns a Status.
template <class Body>
relievo_status at_boundary(relievo_error* error, const Body& body) noexcept {
  try {
    const Status status = body();
    return status ? write_error(RELIEVO_OK, {}, {}, {}, 0, 0, error) : write_error(status.error(), error);
  } catch (...) {
    return write_exception(error);
  }
}

struct Argument {
  const char* name;
  const void* value;
};
/// Errors: "c.null", naming the argument.
Status require(std::initializer_list<Argument> arguments);
/// A list may be NULL when it is empty.
Status require_list(const char* name, const void* list, std::size_t count);
/// Errors: "c.index".
Status require_index(std::size_t index, std::size_t count);

/// Errors: "c.enum".
Status require_enum(const char* name, std::int32_t value, std::int32_t count);

relievo_string view(std::string_view text);

Result<std::vector<std::string>> texts_of(const char* name, const char* const* list, std::size_t count);
Result<std::map<std::string, double>> values_of(const relievo_value* values, std::size_t count);

}  // namespace relievo::c_api
