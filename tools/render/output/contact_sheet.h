// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace kiln {

/// A picture and the lines under it.
struct SheetCell {
  Image<std::uint8_t> picture;  ///< RGB or RGBA; all pictures of a sheet have the same size
  std::vector<std::string> caption;
};

/// Arranges pictures on one sheet (RGB, dark) close to 16:9, each with its caption beneath. Throws MachineLacks without
/// the font.
Image<std::uint8_t> contact_sheet(const std::vector<SheetCell>& cells);

}  // namespace kiln
