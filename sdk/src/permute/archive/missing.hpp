/// Answers for what an archive does not have.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "permute/archive/index.hpp"

namespace relievo::archive {

/// "no permutation technique=relief address=clamp; nearest: technique=relief (differs in address: repeat)".
std::string explain_missing(const Index& index,
                            std::span<const std::pair<std::string_view, std::string_view>> assignment);

std::vector<std::pair<Target, std::string_view>> absent_targets(const Index& index, std::uint32_t entry);

/// "archive.no-output": the reason why a target is absent (ErrorCode::unsupported), else what there is.
Error explain_no_output(const Index& index, std::uint32_t entry, ShaderStage stage, const Target& target);

}  // namespace relievo::archive
