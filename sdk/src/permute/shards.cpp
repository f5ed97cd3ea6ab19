#include "permute/shards.hpp"

#include <algorithm>
#include <numeric>

namespace relievo {

std::vector<unsigned> assign_shards(const std::vector<double>& seconds, unsigned shards) {
  std::vector<std::size_t> order(seconds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return seconds[a] > seconds[b]; });
  std::vector<double> load(shards, 0);
  std::vector<unsigned> assigned(seconds.size(), 0);
  for (const std::size_t i : order) {
    const auto least = std::min_element(load.begin(), load.end());
    *least += seconds[i];
    assigned[i] = static_cast<unsigned>(least - load.begin());
  }
  return assigned;
}

}  // namespace relievo
