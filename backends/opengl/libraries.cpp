#include "libraries.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace relievo::opengl {

std::string missing_library(const std::vector<std::vector<std::string>>& alternatives) {
  for (const auto& sonames : alternatives) {
    // The handle is kept: libepoxy opens the same library again, and drivers do not like to be unloaded.
    const bool opens = std::any_of(sonames.begin(), sonames.end(), [](const std::string& soname) {
      return dlopen(soname.c_str(), RTLD_LAZY | RTLD_LOCAL) != nullptr;
    });
    if (!opens) return fmt::format("the driver library {} is not installed", fmt::join(sonames, " or "));
  }
  return {};
}

std::string missing_driver_library() {
  return missing_library({{"libEGL.so.1"}, {"libGL.so.1", "libOpenGL.so.0"}});
}

}  // namespace relievo::opengl
