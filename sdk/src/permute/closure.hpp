/// What decides a program: its composed sources and its frozen constants.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "permute/freeze.hpp"
#include "relievo/cache.hpp"
#include "relievo/compile.hpp"

namespace relievo {

/// A permutation without what does not change its program: values of uniforms, which the application sets, and of
/// specialization constants, which are frozen after the front end. Macros are in the text and leave no other trace.
struct Closure {
  ComposedProgram program;
  std::vector<FrozenConstant> frozen;
  std::string fallback;  ///< the stage's
};

/// Specialization constants that the permutation gives a value are frozen, others stay open. Errors: those of
/// composing.
Result<Closure> compose_closure(const Registry& registry, const Permutation& permutation);

/// What the reflection of a program says beside its shaders: parameters, maps, features.
std::string describe_contract(const ComposedProgram& program);

CacheKey closure_key(const Closure& closure, std::span<const Target> targets, bool optimize);

}  // namespace relievo
