#include "common.hpp"

namespace relievo::cli {

void add_archive(CLI::App&, Context&) {}

}  // namespace relievo::cli
