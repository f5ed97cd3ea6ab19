#include "permute/hot_reload/watch.hpp"

#include <algorithm>
#include <system_error>

namespace relievo {

namespace fs = std::filesystem;

namespace {

/// The coarsest times of files that are common (FAT): within them two writes of one size look the same.
constexpr std::chrono::seconds coarsest_time{2};
constexpr int max_entries = 100000;

bool is_source(const fs::path& path) {
  return path.extension() == ".glsl" || path.extension() == ".toml";
}

}  // namespace

FolderWatch::FolderWatch(std::vector<fs::path> folders, std::chrono::milliseconds settle)
    : folders_(std::move(folders)), settle_(settle), taken_(look()), seen_(taken_), since_(Clock::now()) {
  // The first reading may have met a file between two writes.
  if (is_fresh()) again_ = since_ + coarsest_time;
}

FolderWatch::Stamps FolderWatch::look() const {
  Stamps stamps;
  for (const fs::path& folder : folders_) {
    std::error_code error;
    int entries = 0;
    fs::recursive_directory_iterator entry(folder, error), end;
    for (; !error && entry != end && ++entries <= max_entries; entry.increment(error)) {
      if (entry->path().filename().native().starts_with('.')) {
        entry.disable_recursion_pending();
        continue;
      }
      if (!is_source(entry->path())) continue;
      std::error_code gone;
      const std::uintmax_t size = fs::file_size(entry->path(), gone);
      const fs::file_time_type time = gone ? fs::file_time_type() : fs::last_write_time(entry->path(), gone);
      if (!gone) stamps[entry->path().generic_string()] = {size, time};
    }
  }
  return stamps;
}

bool FolderWatch::is_fresh() const {
  const auto now = fs::file_time_type::clock::now();
  return std::any_of(seen_.begin(), seen_.end(), [&](const auto& file) {
    return file.second.time > now - coarsest_time && file.second.time < now + coarsest_time;
  });
}

bool FolderWatch::has_settled_change(Clock::time_point now) {
  Stamps stamps = look();
  if (stamps != seen_) {
    seen_ = std::move(stamps);
    since_ = now;
  }
  if (now - since_ < settle_) return false;
  if (seen_ == taken_ && now < again_) return false;
  again_ = is_fresh() ? now + coarsest_time : Clock::time_point::max();
  taken_ = seen_;
  return true;
}

}  // namespace relievo
