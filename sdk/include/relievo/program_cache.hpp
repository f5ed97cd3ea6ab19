/// Keeping the programs that Jobs are made of.
#pragma once

#include <memory>

#include "relievo/cache.hpp"

namespace relievo {

/// From now on the makers of Jobs of this process (trace, render, bake_map, …) look programs up in `cache` before they
/// compile them, and keep there what they compiled: programs are the same with and without. At the start that is a
/// cache in memory of 32 MiB; null: every program is compiled. Thread-safe.
void use_program_cache(std::shared_ptr<Cache> cache);

}  // namespace relievo
