// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"

namespace kiln {

/// A row of a panel: a dim label, and its text.
struct PanelRow {
  std::string label;
  std::string value;
};

struct Panel {
  std::string title;  ///< empty: none
  std::vector<PanelRow> rows;

  bool operator==(const Panel&) const;
};

/// Makes a strip of as few lines as fit `width` pixels from a panel, for windows without room beside the asset.
Panel strip_of(const Panel& panel, int width, double scale);

/// Draws the panel as a picture (RGBA, straight alpha): bright text in two aligned columns on a dark, half-transparent
/// ground with round corners. `scale` is the display's, 1 for about 96 dots per inch. Throws MachineLacks without the
/// font.
Image<std::uint8_t> panel_picture(const Panel& panel, double scale);

}  // namespace kiln
