// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "image/image.h"
#include "view/state/panel_text.h"

namespace kiln {

/// Makes a strip of as few lines as fit `width` pixels from a panel, for windows without room beside the asset.
Panel strip_of(const Panel& panel, int width, double scale);

/// Draws the panel as a picture (RGBA, straight alpha): bright text in two aligned columns on a dark, half-transparent
/// ground with round corners. `scale` is the display's, 1 for about 96 dots per inch. Throws MachineLacks without the
/// font.
Image<std::uint8_t> panel_picture(const Panel& panel, double scale);

}  // namespace kiln
