/// Dividing closures among machines.
#pragma once

#include <string>
#include <vector>

#include "relievo/permute.hpp"

namespace relievo {

/// The shard of each closure: longest first, each to the shard with the least to do. `seconds` has one entry a
/// closure, in the order of their keys, in which ties are broken; so every machine finds the same.
std::vector<unsigned> assign_shards(const std::vector<double>& seconds, unsigned shards);

}  // namespace relievo
