/// The driver libraries, opened before libepoxy is touched: libepoxy ends the program when one is missing.
#pragma once

#include <string>
#include <vector>

namespace relievo::opengl {

/// Each entry lists the sonames of which one must open. Returns one sentence naming what is missing, or nothing.
std::string missing_library(const std::vector<std::vector<std::string>>& alternatives);

/// What this backend needs: EGL, and desktop OpenGL under either of its sonames.
std::string missing_driver_library();

}  // namespace relievo::opengl
