/// Numbers of a rendered AOV as something to look at.
#pragma once

#include "relievo/compose.hpp"
#include "relievo/image.hpp"

namespace relievo::cli {

/// Four channels, in [0,1] where they are shown as they are: uv without whole tiles; normals and directions from
/// [-1,1]; depth in greys from white to a tenth, the nearest and the farthest hundredth of the pixels; steps in greys
/// by the most; statuses in greys of fifths, a miss the first. What nothing was drawn on is black. Alpha is 1.
Image aov_picture(Image numbers, Aov aov);

}  // namespace relievo::cli
