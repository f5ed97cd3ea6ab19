/// The driver's own compiler for emitted GLSL and ESSL, through EGL without a window.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "relievo/compile.hpp"

namespace relievo::testing {

/// A current OpenGL context: 4.5 core, or ES 3.2. One thread, one live context at a time.
class GlCompiler {
 public:
  /// `language` is glsl or essl. Null when the driver has no such context; `reason` then says why.
  static std::unique_ptr<GlCompiler> create(Language language, std::string& reason);
  ~GlCompiler();
  GlCompiler(const GlCompiler&) = delete;
  GlCompiler& operator=(const GlCompiler&) = delete;

  /// Compiles and links a program's texts for `target`, and looks up every entry of its binding contract by name.
  /// Returns an empty string when all is well, else the driver's log.
  std::string check(const Target& target, const CompiledProgram& program);

 private:
  GlCompiler(void* display, void* context) : display_(display), context_(context) {}
  void* display_;
  void* context_;
};

}  // namespace relievo::testing
