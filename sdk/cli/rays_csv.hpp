/// rays.csv and hits.csv of design.md §7.
#pragma once

#include <string>
#include <vector>

#include "relievo/oracle.hpp"

namespace relievo::cli {

/// Reads `u,v,h,du,dv,dh[,t_max]` after a header line; "-" is stdin. Errors ("rays.*") name file, line and column.
/// An empty t_max means no limit. Values may be inf or nan: such rays miss.
Result<std::vector<Ray>> read_rays(const std::string& path);

/// `status,t,u,v,h,steps,fetches`, one row a ray; `digits` significant: 9 for float results, 17 for double.
std::string format_hits(const std::vector<Hit>& hits, int digits);

}  // namespace relievo::cli
