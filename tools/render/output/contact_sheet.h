// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace kiln {

/// A picture and the lines under it.
struct SheetCell {
  Image<std::uint8_t> picture;  ///< RGB or RGBA, all of a sheet of one size
  std::vector<std::string> caption;
};

/// The pictures on one sheet (RGB, dark), as many columns as bring it nearest to 16:9, each with its caption beneath.
/// Throws MachineLacks without the font.
Image<std::uint8_t> contact_sheet(const std::vector<SheetCell>& cells);

}  // namespace kiln
