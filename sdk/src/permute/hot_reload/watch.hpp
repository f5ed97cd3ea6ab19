/// Whether files below some folders have changed, seen from outside: names, sizes and times.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace relievo {

class FolderWatch {
 public:
  using Clock = std::chrono::steady_clock;

  FolderWatch(std::vector<std::filesystem::path> folders, std::chrono::milliseconds settle);

  /// True once for every change, when the files have stayed as they are for the time to settle. Never throws for what
  /// lies there: a folder that is gone has no files.
  bool has_settled_change(Clock::time_point now);
  /// A change was seen, and is not settled yet.
  bool is_waiting() const { return seen_ != taken_; }

 private:
  struct Stamp {
    std::uintmax_t size = 0;
    std::filesystem::file_time_type time;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  using Stamps = std::map<std::string, Stamp>;

  Stamps look() const;
  /// Whether a file of `seen_` changed so lately that another write may have the same time.
  bool is_fresh() const;

  std::vector<std::filesystem::path> folders_;
  std::chrono::milliseconds settle_;
  Stamps taken_, seen_;
  Clock::time_point since_;                             ///< when `seen_` was first seen
  Clock::time_point again_ = Clock::time_point::max();  ///< when to take it once more
};

}  // namespace relievo
