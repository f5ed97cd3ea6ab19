#include "compile/optimize.hpp"

#include <fmt/format.h>

#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>
#include <spirv_cross/spirv.hpp>

namespace relievo {

namespace {

constexpr spv_target_env kEnvironment = SPV_ENV_VULKAN_1_0;

spvtools::MessageConsumer collect_into(std::string& messages) {
  return [&messages](spv_message_level_t level, const char*, const spv_position_t&, const char* message) {
    if (level > SPV_MSG_ERROR) return;
    if (!messages.empty()) messages += "; ";
    messages += message;
  };
}

/// Removes what a permutation does not use and what is decided at compile time. Functions stay functions: drivers
/// inline by themselves, and the emitted text keeps the author's structure, at a third of the size and time. Nothing
/// rewrites arithmetic: contracting a·b+c into fma would let targets disagree about a hit. Blocks are not merged: a
/// loop's step in a block of its own is what lets the emitters write `for (…; ++i)`. Operations on specialization
/// constants are folded where all of those are frozen.
void register_passes(spvtools::Optimizer& optimizer, bool has_constant_operations) {
  if (has_constant_operations) optimizer.RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass());
  optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
      .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
      .RegisterPass(spvtools::CreateCCPPass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass());
}

bool has_constant_operations(const SpirvWords& words) {
  bool found = false;
  for_each_instruction(words, [&](const SpirvInstruction& instruction) {
    found = found || instruction.opcode == spv::OpSpecConstantOp || instruction.opcode == spv::OpSpecConstantComposite;
  });
  return found;
}

tl::unexpected<Error> invalid(std::string_view key, std::string_view when, const std::string& messages) {
  return fail(ErrorCode::compile, "compile.spirv-invalid",
              fmt::format("the SPIR-V of permutation '{}' is invalid {}: {}", key, when, messages));
}

}  // namespace

Status validate_spirv(const SpirvWords& words, std::string_view permutation_key, std::string_view when) {
  std::string messages;
  spvtools::SpirvTools tools(kEnvironment);
  tools.SetMessageConsumer(collect_into(messages));
  spvtools::ValidatorOptions options;
  options.SetFriendlyNames(false);  // making names costs more than validating
  if (!tools.Validate(words.data(), words.size(), options)) return invalid(permutation_key, when, messages);
  return {};
}

Result<SpirvWords> optimize_spirv(const SpirvWords& words, std::string_view permutation_key) {
  std::string messages;
  spvtools::Optimizer optimizer(kEnvironment);
  optimizer.SetMessageConsumer(collect_into(messages));
  register_passes(optimizer, has_constant_operations(words));
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);  // the pipeline validates before and after
  SpirvWords optimized;
  if (!optimizer.Run(words.data(), words.size(), &optimized, options)) {
    return invalid(permutation_key, "for the optimizer", messages);
  }
  return optimized;
}

}  // namespace relievo
