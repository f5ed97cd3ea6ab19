#include <sys/resource.h>
#include <algorithm>
#include <chrono>

#include "evaluation/evaluation.hpp"

namespace relievo::cli {

namespace {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

}  // namespace

PhaseClock::PhaseClock() : seconds_(wall_seconds()), processor_seconds_(processor_seconds()) {}

void PhaseClock::end(const std::string& name) {
  auto phase = std::find_if(phases_.begin(), phases_.end(), [&](const Phase& p) { return p.name == name; });
  if (phase == phases_.end()) phase = phases_.insert(phase, Phase{name, 0, 0});
  const double now = wall_seconds(), used = processor_seconds();
  phase->seconds += now - seconds_;
  phase->processor_seconds += used - processor_seconds_;
  seconds_ = now;
  processor_seconds_ = used;
}

}  // namespace relievo::cli
