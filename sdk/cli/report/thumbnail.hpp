/// Small copies of pictures, so that a page of hundreds can be sent by mail.
#pragma once

#include <filesystem>
#include <string>

#include "relievo/image.hpp"

namespace relievo::cli {

/// The image reduced by a whole factor to at most `largest` pixels a side (never less than one), each pixel the mean of
/// those it stands for, over `background` where it is transparent, in `levels` steps a channel: RGB.
Image reduce(const Image& image, int largest, float background, int levels);

/// The picture `folder`/`file` as a small one in a data URI. Keeps it in `folder`/small. Errors: "image.*",
/// "report.picture".
Result<std::string> thumbnail_uri(const std::filesystem::path& folder, const std::string& file);

}  // namespace relievo::cli
