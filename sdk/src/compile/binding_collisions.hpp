/// A check on emitted texts: no two resources at one place.
#pragma once

#include <string>
#include <string_view>

#include "relievo/compile.hpp"

namespace relievo {

/// The first register, binding or index that two resources share in an emitted text; empty when there is none.
std::string find_binding_collision(Language language, std::string_view text);

}  // namespace relievo
