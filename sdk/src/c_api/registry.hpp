/// The registry behind its handle.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "relievo.h"
#include "relievo/describe.hpp"

/// What C may hold views of is made once, here.
struct relievo_registry {
  struct Item {
    std::string name, title, source, summary, json;
    const std::vector<relievo::Parameter>* parameters = nullptr;
  };
  relievo::Registry registry;
  std::vector<Item> items[3];  ///< by relievo_kind, each by name
};

namespace relievo::c_api {

/// Values of parameters by "owner.parameter". Errors: "c.null"; "c.parameter" for one that nothing has, naming the
/// nearest.
Result<std::map<std::string, double>> values_of(const relievo_registry& registry, const relievo_value* values,
                                                std::size_t count);

}  // namespace relievo::c_api
