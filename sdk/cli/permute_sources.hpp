/// The composed GLSL of a plan's permutations, for other tools.
#pragma once

#include <string>

#include "relievo/permute.hpp"

namespace relievo::cli {

/// Writes a folder a permutation below `folder`, with a file a shader ("fragment.frag"): of all that are kept, or of
/// `sample` of them, evenly spread.
Status write_sources(const Registry& registry, const Manifest& manifest, const PermutationPlan& plan,
                     const std::string& folder, std::size_t sample);

}  // namespace relievo::cli
