// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "image/image.h"

namespace kiln {

/// Returns the width in pixels of a line of text in DejaVu Sans of `size` pixels. ASCII only: OpenImageIO 2.4 draws
/// other characters wrongly.
int text_width(const std::string& text, int size);

/// Draws a line of text into an RGB or RGBA picture, in grey of `brightness` 0 to 1, opaque; its baseline starts at
/// pixel (left, baseline), rows from the bottom. Parts outside the picture are cut off. Throws MachineLacks without the
/// font.
void draw_text(Image<std::uint8_t>& image, int left, int baseline, const std::string& text, int size,
               float brightness = 1);

}  // namespace kiln
