/// Walking the instructions of a SPIR-V module, and dropping its debug lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace relievo {

using SpirvWords = std::vector<std::uint32_t>;

/// One instruction; `operands` starts after the opcode word, so it includes result type and result id.
struct SpirvInstruction {
  std::uint32_t opcode = 0;
  std::span<const std::uint32_t> operands;
};

constexpr std::size_t kSpirvHeaderWords = 5;

/// Calls `visit(SpirvInstruction)` for each instruction in order; stops early at a malformed length.
template <class Visit>
void for_each_instruction(std::span<const std::uint32_t> words, Visit&& visit) {
  std::size_t at = kSpirvHeaderWords;
  while (at < words.size()) {
    const std::size_t length = words[at] >> 16;
    if (length == 0 || at + length > words.size()) return;
    visit(SpirvInstruction{words[at] & 0xffffu, words.subspan(at + 1, length - 1)});
    at += length;
  }
}

/// The literal string that starts at `operands[0]`.
std::string spirv_string(std::span<const std::uint32_t> operands);

/// Drops line information and embedded sources, keeps names and the source language (which the emitters read).
SpirvWords strip_lines(std::span<const std::uint32_t> words);

}  // namespace relievo
