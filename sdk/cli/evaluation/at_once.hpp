/// Backends side by side: drivers compile on one thread each.
#pragma once

#include <future>
#include <vector>

#include "relievo/result.hpp"

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

}  // namespace relievo::cli
