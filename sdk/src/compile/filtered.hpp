/// Which textures a shader reads through the filter of their samplers.
#pragma once

#include <set>

#include "compile/spirv_words.hpp"

namespace relievo {

/// Ids of the variables that an instruction samples, directly or where functions are given them. Fetches, gathers and
/// queries do not filter.
std::set<std::uint32_t> filtered_variables(std::span<const std::uint32_t> words);

}  // namespace relievo
