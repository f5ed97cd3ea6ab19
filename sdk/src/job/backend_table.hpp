/// The backends built into the library: generated from the folders of backends/.
#pragma once

#include <vector>

#include "relievo/backend.hpp"

namespace relievo {

const std::vector<const BackendFactory*>& backend_table();

}  // namespace relievo
