#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace kiln {

/// Fills every uncovered texel by push-pull (Gortler, Grzeszczuk, Szeliski and Cohen, "The Lumigraph", 1996): covered
/// texels are averaged into ever coarser levels, and holes are filled from the next coarser one; but a texel within one
/// of a covered one (its 8 neighbours) gets the mean of its covered neighbours, so that bilinear lookups at a chart's
/// edge see only the chart's own values. Covered texels keep their value. `covered` has one entry per texel, nonzero
/// where covered, rows from the bottom. An image with no covered texel is left as it is.
void fill_gutters(Image<float>& image, const std::vector<std::uint8_t>& covered);

}  // namespace kiln
