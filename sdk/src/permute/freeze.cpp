#include "permute/freeze.hpp"

#include <optional>
#include <spirv_cross/spirv.hpp>
#include <unordered_map>

namespace relievo {

namespace {

std::optional<std::uint32_t> value_of(std::span<const FrozenConstant> constants, std::uint32_t spec_id) {
  for (const FrozenConstant& constant : constants) {
    if (static_cast<std::uint32_t>(constant.id) == spec_id) return constant.bits;
  }
  return std::nullopt;
}

bool is_spec_id(const SpirvInstruction& instruction) {
  return instruction.opcode == spv::OpDecorate && instruction.operands.size() == 3 &&
         instruction.operands[1] == spv::DecorationSpecId;
}

void append(const SpirvInstruction& instruction, SpirvWords& words) {
  words.push_back(static_cast<std::uint32_t>(instruction.operands.size() + 1) << 16 | instruction.opcode);
  words.insert(words.end(), instruction.operands.begin(), instruction.operands.end());
}

}  // namespace

SpirvWords freeze(std::span<const std::uint32_t> words, std::span<const FrozenConstant> constants) {
  if (constants.empty()) return SpirvWords(words.begin(), words.end());
  std::unordered_map<std::uint32_t, std::uint32_t> frozen;  // result id → bits
  SpirvWords result(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(kSpirvHeaderWords));
  result.reserve(words.size());
  // Decorations come before the constants that they decorate.
  for_each_instruction(words, [&](const SpirvInstruction& instruction) {
    if (is_spec_id(instruction)) {
      if (const auto bits = value_of(constants, instruction.operands[2])) {
        frozen[instruction.operands[0]] = *bits;
        return;
      }
    }
    const bool is_constant = instruction.opcode == spv::OpSpecConstant && instruction.operands.size() == 3;
    const auto found = is_constant ? frozen.find(instruction.operands[1]) : frozen.end();
    if (found == frozen.end()) return append(instruction, result);
    const std::uint32_t operands[] = {instruction.operands[0], instruction.operands[1], found->second};
    append({spv::OpConstant, operands}, result);
  });
  return result;
}

}  // namespace relievo
