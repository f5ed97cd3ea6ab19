/// Depfiles, as Make and Ninja read them.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "relievo/describe.hpp"

namespace relievo::cli {

/// Where what was compiled lies on disk: the sources that are not built in, and the descriptors, which decide as well.
std::set<std::string> files_on_disk(const Registry& registry, const std::vector<std::string>& sources);

/// The rule that `target` is made from the files.
std::string depfile_rule(const std::string& target, const std::set<std::string>& files);

}  // namespace relievo::cli
