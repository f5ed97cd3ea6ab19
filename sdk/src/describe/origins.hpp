/// Where sources lie on disk.
#pragma once

#include "relievo/describe.hpp"

namespace relievo {

/// A user looks for the file where it lies on disk.
Error name_file_on_disk(Error error, const Registry& registry);

}  // namespace relievo
