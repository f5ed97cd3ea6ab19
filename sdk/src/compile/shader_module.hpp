/// One shader's SPIR-V, parsed once; every emitter starts from a copy of the parsed form. Copies of a module share it.
#pragma once

#include <memory>
#include <spirv_cross/spirv_reflect.hpp>
#include <vector>

#include "compile/spirv_words.hpp"
#include "relievo/job.hpp"
#include "relievo/result.hpp"

namespace relievo {

struct ShaderModule {
  ShaderStage stage = ShaderStage::compute;
  std::shared_ptr<const SpirvWords> spirv;
  std::shared_ptr<const spirv_cross::ParsedIR> ir;
  std::shared_ptr<const spirv_cross::CompilerReflection> reflection;
  spirv_cross::ShaderResources resources;  ///< only what the entry point uses

  spv::ExecutionModel execution_model() const { return reflection->get_execution_model(); }
};

/// Parses. Errors: "compile.emit" with SPIRV-Cross's words.
Result<ShaderModule> parse_module(ShaderStage stage, std::shared_ptr<const SpirvWords> spirv,
                                  std::string_view permutation_key);

/// "While <doing> permutation '<key>': <reason>", id "compile.emit".
tl::unexpected<Error> emit_error(std::string_view doing, std::string_view permutation_key, std::string_view reason);

/// Calls `work` and turns what SPIRV-Cross throws into an `emit_error`.
template <class Work>
auto catch_emit_errors(std::string_view doing, std::string_view permutation_key, Work&& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& error) {
    return emit_error(doing, permutation_key, error.what());
  }
}

}  // namespace relievo
