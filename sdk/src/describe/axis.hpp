/// [axes.*]: parameters whose values have names.
#pragma once

#include <string>

#include "describe/toml_reader.hpp"
#include "relievo/describe.hpp"

namespace relievo {

/// Reads what an axis has beyond a parameter's title and binding; `owner` is the descriptor's name.
void read_axis(TomlReader& table, const std::string& owner, Parameter& axis);

}  // namespace relievo
