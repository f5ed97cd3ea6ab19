#include "evaluation/at_once.hpp"

#include <algorithm>
#include <atomic>
#include <memory>

#include "common.hpp"

namespace relievo::cli {

Status share_work(Backend& backend, std::span<const BackendWork> pieces) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&](Backend& one) -> Status {
    for (std::size_t i = next++; i < pieces.size(); i = next++) {
      Status status = pieces[i](one);
      if (status) continue;
      next = pieces.size();
      return status;
    }
    return {};
  };
  std::vector<Backend*> backends(std::min(backends_at_once, pieces.size()));
  if (!backends.empty()) backends.front() = &backend;
  return for_each_at_once(backends, [&](Backend* one) -> Status {
    if (one) return work(*one);
    Result<std::unique_ptr<Backend>> other = open(backend.info().name, false);
    return other ? work(**other) : Status();
  });
}

}  // namespace relievo::cli
