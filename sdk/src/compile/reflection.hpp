/// The reflection JSON of a compiled program; its schema is in docs/reflection.md.
#pragma once

#include <span>
#include <string>

#include "compile/bindings.hpp"
#include "relievo/compile.hpp"

namespace relievo {

/// The version of the schema; grows when a key changes its meaning or goes.
constexpr int kReflectionSchema = 1;

/// What SPIRV-Cross reflects of each shader, and what it lacks. `targets` are those that were emitted.
/// Errors: "compile.emit".
Result<std::string> make_reflection(const ComposedProgram& program, std::span<const ShaderModule> modules,
                                    const BindingLayout& layout, std::span<const Target> targets);

}  // namespace relievo
