/// Collects the first thing that is wrong with a job.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "relievo/result.hpp"

namespace relievo {

/// Remembers the first requirement that does not hold. Every message starts with the job's name and the current
/// context ("command 2 (dispatch of \"relief\")").
class Check {
 public:
  explicit Check(std::string job) : job_(std::move(job)) {}

  void enter(std::string context) { context_ = std::move(context); }
  bool ok() const { return !error_; }

  /// Returns `holds`, so that a check which relies on it can be guarded by it.
  template <class... Args>
  bool require(bool holds, const char* id, fmt::format_string<Args...> sentence, Args&&... args) {
    if (!holds && !error_) report(id, fmt::format(sentence, std::forward<Args>(args)...));
    return holds;
  }

  Status status() const { return error_ ? Status(tl::unexpect, *error_) : Status(); }

 private:
  void report(const char* id, const std::string& sentence) {
    error_ = Error{ErrorCode::usage, id, fmt::format("Job \"{}\", {}: {}", job_, context_, sentence), {}, 0, 0};
  }

  std::string job_, context_;
  std::optional<Error> error_;
};

}  // namespace relievo
