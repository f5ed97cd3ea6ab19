/// rays.csv and hits.csv of design.md §7.
#pragma once

#include <string>
#include <vector>

#include "relievo/oracle.hpp"

namespace relievo::cli {

/// Reads `u,v,h,du,dv,dh[,t_max]` after a header line; "-" is stdin. Errors ("rays.*") name file, line and column.
/// An empty t_max means no limit. Values may be inf or nan: such rays miss.
Result<std::vector<Ray>> read_rays(const std::string& path);

/// Significant digits by which numbers can be read back as they were: 9 for a float, 17 for a double.
struct HitDigits {
  int distance;  ///< t and h
  int place;     ///< u and v: a float within a tile is none any more once tiles are added
};
inline constexpr HitDigits backend_digits = {9, 17}, oracle_digits = {17, 17};

/// `status,t,u,v,h,steps,fetches`, one row a ray.
std::string format_hits(const std::vector<Hit>& hits, HitDigits digits);

}  // namespace relievo::cli
