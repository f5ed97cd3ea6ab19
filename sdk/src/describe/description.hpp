/// All that a descriptor says, as JSON: `relievo describe --json`, and the C API.
#pragma once

#include <nlohmann/json.hpp>

#include "relievo/describe.hpp"

namespace relievo {

nlohmann::json description_of(const TechniqueDescriptor& technique);
nlohmann::json description_of(const MapDescriptor& map);
nlohmann::json description_of(const StageDescriptor& stage);

}  // namespace relievo
