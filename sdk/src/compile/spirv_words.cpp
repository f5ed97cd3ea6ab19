#include "compile/spirv_words.hpp"

#include <spirv_cross/spirv.hpp>

namespace relievo {

namespace {

bool is_line_information(std::uint32_t opcode) {
  switch (opcode) {
    case spv::OpSourceContinued:
    case spv::OpSourceExtension:
    case spv::OpString:
    case spv::OpLine:
    case spv::OpNoLine:
    case spv::OpModuleProcessed:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::string spirv_string(std::span<const std::uint32_t> operands) {
  std::string text;
  for (const std::uint32_t word : operands) {
    for (int shift = 0; shift < 32; shift += 8) {
      const char c = static_cast<char>((word >> shift) & 0xffu);
      if (c == 0) return text;
      text += c;
    }
  }
  return text;
}

SpirvWords strip_lines(std::span<const std::uint32_t> words) {
  constexpr std::uint32_t kSourceWords = 3;  // opcode, language, version: without file and text
  SpirvWords result(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(kSpirvHeaderWords));
  result.reserve(words.size());
  for_each_instruction(words, [&](const SpirvInstruction& instruction) {
    if (is_line_information(instruction.opcode)) return;
    std::span<const std::uint32_t> operands = instruction.operands;
    if (instruction.opcode == spv::OpSource) operands = operands.first(kSourceWords - 1);
    result.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16 | instruction.opcode);
    result.insert(result.end(), operands.begin(), operands.end());
  });
  return result;
}

}  // namespace relievo
