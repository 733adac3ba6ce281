#pragma once

#include <string>

#include "render/image.h"

namespace pregrasp {

/// A JPEG file's bytes: for pages, where a PNG's size counts. Without a time stamp, colours at full
/// resolution, so that thin lines and texts stay sharp. The same picture gives the same bytes.
/// @param quality  1 to 100.
std::string EncodeJpeg(const Image& image, int quality);

}  // namespace pregrasp
