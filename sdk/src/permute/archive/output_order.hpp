/// The one order in which the outputs of a program, and targets, lie in files.
#pragma once

#include <compare>
#include <span>
#include <tuple>

#include "relievo/archive.hpp"

namespace relievo::archive {

inline auto order_of(const Target& target) {
  return std::make_tuple(static_cast<int>(target.language), target.version);
}
inline auto order_of(ShaderStage stage, const Target& target) {
  return std::tuple_cat(std::make_tuple(static_cast<int>(stage)), order_of(target));
}

inline bool is_stage(std::uint32_t value) {
  return value <= static_cast<std::uint32_t>(ShaderStage::compute);
}
inline bool is_language(std::uint32_t value) {
  return value <= static_cast<std::uint32_t>(Language::msl);
}
inline bool is_target(const Target& target) {
  return is_language(static_cast<std::uint32_t>(target.language)) && target.version >= 0;
}

/// Known stages and languages, ascending, each once.
inline bool in_order(std::span<const ProgramOutput> outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const ProgramOutput& output = outputs[i];
    if (!is_stage(static_cast<std::uint32_t>(output.stage)) || !is_target(output.target)) return false;
    if (i > 0 && order_of(outputs[i - 1].stage, outputs[i - 1].target) >= order_of(output.stage, output.target))
      return false;
  }
  return true;
}

}  // namespace relievo::archive
