// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace kiln {

/// Fills every uncovered texel by push-pull [Gortler 1996]: covered texels are averaged into ever coarser levels, and
/// holes are filled from the next coarser one. A texel next to a covered one (8 neighbours) gets the mean of its
/// covered neighbours instead, so that bilinear lookups at a chart's edge see only the chart's own values. Covered
/// texels keep their value. `covered` has one entry per texel, nonzero where covered, rows from the bottom. An image
/// with no covered texel is left unchanged.
void fill_gutters(Image<float>& image, const std::vector<std::uint8_t>& covered);

}  // namespace kiln
