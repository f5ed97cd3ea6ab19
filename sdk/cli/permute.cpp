#include "common.hpp"

namespace relievo::cli {

void add_permute(CLI::App&, Context&) {}

}  // namespace relievo::cli
