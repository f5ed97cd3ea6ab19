/// What a backend has made of programs, kept from job to job.
#pragma once

#include <algorithm>
#include <list>
#include <memory>
#include <utility>

#include "relievo/job.hpp"

namespace relievo {

/// A job that comes again, or the next slab of a bake, need not wait for the driver's compiler once more. The programs
/// used last are kept, up to `capacity`; one that is dropped lives on as long as a job holds it.
template <class Made>
class RecentPrograms {
 public:
  static constexpr std::size_t capacity = 16;

  /// Null when there is none of this very source.
  std::shared_ptr<Made> find(const ShaderProgram& source) {
    const auto found =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.source == source; });
    if (found == entries_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found);
    return found->made;
  }

  std::shared_ptr<Made> keep(const ShaderProgram& source, Made made) {
    entries_.push_front({source, std::make_shared<Made>(std::move(made))});
    if (entries_.size() > capacity) entries_.pop_back();
    return entries_.front().made;
  }

  void clear() { entries_.clear(); }

 private:
  struct Entry {
    ShaderProgram source;
    std::shared_ptr<Made> made;
  };
  std::list<Entry> entries_;  // last used first
};

}  // namespace relievo
