/// Maps baked in tests, and the faults that are put into them.
#pragma once

#include <map>
#include <string>

#include "relievo/certify.hpp"
#include "support/height_maps.hpp"
#include "support/pipeline.hpp"

namespace relievo::test {

inline MapData baked(const HeightMap& height_map, const std::string& name, const std::map<std::string, double>& values,
                     const std::string& on = "vulkan") {
  MapSet maps = map_set(height_map);
  std::vector<std::string> messages;
  const Status status = bake_map(backend(on), registry(), name, maps, values, &messages);
  EXPECT_THAT(messages, ::testing::IsEmpty()) << name;
  if (!status) {
    ADD_FAILURE() << name << ": " << format(status.error());
    return {};
  }
  return maps.at(name);
}

inline Certificate certified(const HeightMap& height_map, const MapData& map, const CertifyOptions& options = {}) {
  const Result<Certificate> certificate = certify(height_map, map, options);
  if (certificate) return *certificate;
  ADD_FAILURE() << format(certificate.error());
  return {};
}

/// The small maps with every address mode that makes a difference to them.
inline std::vector<NamedMap> addressed_maps() {
  std::vector<NamedMap> maps;
  for (const NamedMap& base : small_maps()) {
    for (AddressMode mode : all_address_modes)
      maps.push_back({base.name + " " + std::string(to_string(mode)), with_address(base.map, mode)});
  }
  return maps;
}

}  // namespace relievo::test
