#include "c_api/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>

namespace relievo::c_api {

static_assert(RELIEVO_ERROR_USAGE == 1 + static_cast<int>(ErrorCode::usage));
static_assert(RELIEVO_ERROR_IO == 1 + static_cast<int>(ErrorCode::io));
static_assert(RELIEVO_ERROR_DESCRIPTOR == 1 + static_cast<int>(ErrorCode::descriptor));
static_assert(RELIEVO_ERROR_COMPILE == 1 + static_cast<int>(ErrorCode::compile));
static_assert(RELIEVO_ERROR_UNSUPPORTED == 1 + static_cast<int>(ErrorCode::unsupported));
static_assert(RELIEVO_ERROR_MISMATCH == 1 + static_cast<int>(ErrorCode::mismatch));
static_assert(RELIEVO_ERROR_BACKEND == 1 + static_cast<int>(ErrorCode::backend));

namespace {

/// What does not fit is cut before a character of UTF-8.
void copy_text(std::string_view text, char* to, std::size_t capacity) noexcept {
  constexpr std::string_view more = "...";
  std::size_t size = text.size();
  if (size >= capacity) {
    size = capacity - 1 - more.size();
    while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80) --size;
  }
  if (size > 0) std::memcpy(to, text.data(), size);
  if (size < text.size()) {
    std::memcpy(to + size, more.data(), more.size());
    size += more.size();
  }
  to[size] = '\0';
}

}  // namespace

relievo_status write_error(relievo_status code, std::string_view id, std::string_view message, std::string_view file,
                           int line, int column, relievo_error* error) noexcept {
  if (!error) return code;
  error->code = code;
  error->line = line;
  error->column = column;
  copy_text(id, error->id, sizeof(error->id));
  copy_text(message, error->message, sizeof(error->message));
  copy_text(file, error->file, sizeof(error->file));
  return code;
}

relievo_status write_error(const Error& failure, relievo_error* error) noexcept {
  return write_error(1 + static_cast<relievo_status>(failure.code), failure.id, failure.message, failure.file,
                     failure.line, failure.column, error);
}

relievo_status write_exception(relievo_error* error) noexcept {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return write_error(RELIEVO_ERROR_MEMORY, "c.memory", "there is not enough memory", {}, 0, 0, error);
  } catch (const std::exception& exception) {
    return write_error(RELIEVO_ERROR_INTERNAL, "c.internal", exception.what(), {}, 0, 0, error);
  } catch (...) {
    return write_error(RELIEVO_ERROR_INTERNAL, "c.internal", "something unknown was thrown", {}, 0, 0, error);
  }
}

Status require(std::initializer_list<Argument> arguments) {
  for (const Argument& argument : arguments) {
    if (argument.value) continue;
    return fail(ErrorCode::usage, "c.null", fmt::format("'{}' is NULL; a value is expected", argument.name));
  }
  return {};
}

Status require_list(const char* name, const void* list, std::size_t count) {
  if (list || count == 0) return {};
  return fail(ErrorCode::usage, "c.null", fmt::format("'{}' is NULL; {} elements are expected", name, count));
}

Status require_index(std::size_t index, std::size_t count) {
  if (index < count) return {};
  return fail(ErrorCode::usage, "c.index", fmt::format("the index is {}; one below {} is expected", index, count));
}

Status require_enum(const char* name, std::int32_t value, std::int32_t count) {
  if (value >= 0 && value < count) return {};
  return fail(ErrorCode::usage, "c.enum",
              fmt::format("'{}' is {}; a number from 0 to {} is expected", name, value, count - 1));
}

relievo_string view(std::string_view text) {
  return {text.data() ? text.data() : "", text.size()};
}

Result<std::vector<std::string>> texts_of(const char* name, const char* const* list, std::size_t count) {
  if (Status status = require_list(name, list, count); !status) return tl::unexpected(status.error());
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    if (Status status = require({{name, list[i]}}); !status) return tl::unexpected(status.error());
    texts.emplace_back(list[i]);
  }
  return texts;
}

Result<std::map<std::string, double>> values_of(const relievo_value* values, std::size_t count) {
  if (Status status = require_list("values", values, count); !status) return tl::unexpected(status.error());
  std::map<std::string, double> by_name;
  for (std::size_t i = 0; i < count; ++i) {
    if (Status status = require({{"values.parameter", values[i].parameter}}); !status)
      return tl::unexpected(status.error());
    by_name[values[i].parameter] = values[i].value;
  }
  return by_name;
}

}  // namespace relievo::c_api
