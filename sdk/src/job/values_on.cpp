#include <algorithm>

#include "relievo/trace.hpp"

namespace relievo {

namespace {

template <class Descriptors>
void add_software_values(const Descriptors& descriptors, const FeatureSet& offered,
                         std::map<std::string, double>& values) {
  for (const auto& [owner, descriptor] : descriptors) {
    for (const Parameter& axis : descriptor.parameters) {
      if (!axis.software_value) continue;
      const FeatureSet& needed = axis.features[static_cast<std::size_t>(*axis.software_value)];
      if (!std::includes(offered.begin(), offered.end(), needed.begin(), needed.end())) continue;
      values.try_emplace(owner + "." + axis.name, *axis.software_value);
    }
  }
}

}  // namespace

std::map<std::string, double> values_on(const Registry& registry, const BackendInfo& backend,
                                        std::map<std::string, double> values) {
  if (!backend.features.contains("software")) return values;
  add_software_values(registry.techniques, backend.features, values);
  add_software_values(registry.maps, backend.features, values);
  add_software_values(registry.stages, backend.features, values);
  return values;
}

}  // namespace relievo
