/// Backends side by side: drivers compile on one thread each.
#pragma once

#include <functional>
#include <future>
#include <span>
#include <vector>

#include "relievo/backend.hpp"

namespace relievo::cli {

/// Calls `work` for each item in a thread of its own. When all are done: the error of the first that failed.
template <class Items, class Work>
Status for_each_at_once(Items& items, const Work& work) {
  std::vector<std::future<Status>> running;
  for (auto& item : items) running.push_back(std::async(std::launch::async, [&work, &item] { return work(item); }));
  Status all;
  for (std::future<Status>& one : running) {
    if (Status status = one.get(); all && !status) all = status;
  }
  return all;
}

/// How many backends of one kind share work; each has its own copies of the textures.
inline constexpr std::size_t backends_at_once = 2;

/// Work for any backend of a kind.
using BackendWork = std::function<Status(Backend&)>;

/// Shares `pieces` between the backend and others of its kind, as far as they can be opened. After a failure no piece
/// is begun.
Status share_work(Backend& backend, std::span<const BackendWork> pieces);

}  // namespace relievo::cli
