// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"

namespace kiln {

/// Returns an image at another size. Where that is smaller, a pixel is the mean of what it covers of the image, parts
/// of pixels by their area; where it is larger, values are interpolated linearly. Each axis for itself.
Image<float> resized(const Image<float>& image, int width, int height);

}  // namespace kiln
