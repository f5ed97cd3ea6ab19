#include "common.hpp"

namespace relievo::cli {

void add_cache(CLI::App&, Context&) {}

}  // namespace relievo::cli
