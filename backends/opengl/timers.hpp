/// The GPU's clock around each command.
#pragma once

#include <utility>
#include <vector>

#include "handles.hpp"

namespace relievo::opengl {

class CommandTimers {
 public:
  /// `enabled` false: no queries are made, and no times come back.
  explicit CommandTimers(bool enabled) : enabled_(enabled) {}

  void begin_command();
  void end_command();
  /// Waits for the GPU. One entry a command, or none.
  std::vector<double> seconds() const;

 private:
  bool enabled_;
  std::vector<std::pair<QueryHandle, QueryHandle>> queries_;
};

}  // namespace relievo::opengl
