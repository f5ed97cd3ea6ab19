/// What a user has without us: the height map as triangles in Embree 3, traced on the CPU.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "relievo/height_map.hpp"
#include "relievo/oracle.hpp"

namespace relievo::cli {

/// One way of asking Embree, and how long it took.
struct RivalRun {
  std::string method;           ///< "rtcIntersect1", "rtcIntersect8 coherent", …
  std::vector<double> seconds;  ///< one a repeat
  std::vector<Hit> hits;        ///< one a ray
};

struct RivalResult {
  std::size_t bytes = 0;           ///< that Embree holds when the scene is built
  std::size_t triangle_bytes = 0;  ///< of these, vertices and indices; the others are its tree
  std::size_t peak_bytes = 0;      ///< held while building
  double build_seconds = 0;
  std::vector<RivalRun> runs;  ///< one a method
  std::size_t fastest = 0;     ///< by the median
};

/// Two triangles a cell between texel centres, `scale` texture widths high. A ray that leaves a tile of the map goes on
/// in the next one, as our techniques do. `threads` take chunks of rays in order.
/// Errors: "bench.no-embree" (unsupported) when the program was built without it, "bench.embree-address" for a map that
/// does not repeat, "bench.embree" when Embree refuses. `before_round` is called before each repeat, so that others can
/// be timed under the same load; its error ends the race.
Result<RivalResult> race_embree(const HeightMap& map, double scale, std::span<const Ray> rays, unsigned threads,
                                int repeats, const std::function<Status()>& before_round);

}  // namespace relievo::cli
