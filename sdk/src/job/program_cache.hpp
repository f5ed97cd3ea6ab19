/// Programs of Jobs, kept between calls and processes.
#pragma once

#include <optional>
#include <string_view>

#include "relievo/compile.hpp"

namespace relievo {

/// What `use_program_cache` was given holds the program of this text for the target, or nothing.
std::optional<ShaderProgram> load_program(const ComposedProgram& composed, std::string_view shader_target);
void store_program(const ComposedProgram& composed, std::string_view shader_target, const ShaderProgram& program);

}  // namespace relievo
