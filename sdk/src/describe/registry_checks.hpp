/// What only the descriptors together can break.
#pragma once

#include "relievo/describe.hpp"

namespace relievo {

/// Modules exist; maps that are required exist; maps' bindings and samplers and shaders' parameter names do not
/// collide; neither maps' inputs nor stages' fallbacks form a cycle. A fallback that does not exist is allowed: it may
/// come later. Errors: "describe.missing-file", "describe.unknown-map", "describe.binding-collision",
/// "describe.duplicate", "describe.cycle", at the value in the descriptor, by source path.
Status check_registry(const Registry& registry);

}  // namespace relievo
