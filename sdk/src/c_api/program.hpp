/// The program behind its handle.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "relievo.h"
#include "relievo/hot_reload.hpp"

/// Handles of one program share what it was composed of and what came out.
struct relievo_program {
  explicit relievo_program(std::shared_ptr<const relievo::HotProgramState> shared)
      : state(std::move(shared)), block(relievo::parameter_block(state->composed)) {}

  std::shared_ptr<const relievo::HotProgramState> state;
  std::vector<std::byte> block;
};

namespace relievo::c_api {

CompileOptions compile_options_of(const relievo_program_desc& desc);

}  // namespace relievo::c_api
