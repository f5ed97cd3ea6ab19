/// Height maps for tests: those of the evaluation, small, with the awkward sizes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sdk/cli/evaluation/synthetic_maps.hpp"

namespace relievo::test {

using namespace synthetic;

inline HeightMap with_address(HeightMap map, AddressMode address) {
  map.address = address;
  return map;
}

inline constexpr std::array<AddressMode, 4> all_address_modes = {AddressMode::repeat, AddressMode::mirror,
                                                                 AddressMode::clamp, AddressMode::clip};

struct NamedMap {
  std::string name;
  HeightMap map;
};

/// One of each kind, small, with the awkward sizes.
inline std::vector<NamedMap> small_maps() {
  return {{"constant 0", constant_map(8, 8, 0)},
          {"constant 1", constant_map(8, 8, 1)},
          {"constant 1/2", constant_map(5, 4, 0.5)},
          {"ramp", ramp_map(16, 8)},
          {"spike", spike_map(16, 16)},
          {"wall", wall_map(16, 16)},
          {"checker", checker_map(16, 16)},
          {"staircase", staircase_map(32, 4)},
          {"plateau", plateau_map(16, 16)},
          {"ridge along", ridge_map(16, 32, false)},
          {"ridge across", ridge_map(32, 16, true)},
          {"smooth noise", smooth_noise_map(32, 32)},
          {"white noise", white_noise_map(16, 16)},
          {"1x1", constant_map(1, 1, 0.25)},
          {"1x9", white_noise_map(1, 9)},
          {"9x1", white_noise_map(9, 1)},
          {"7x13", white_noise_map(7, 13)},
          {"33x20", smooth_noise_map(33, 20)}};
}

}  // namespace relievo::test
