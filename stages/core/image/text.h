#pragma once

#include <string>

#include "image/image.h"

namespace kiln {

/// Width in pixels of a line of text (ASCII: OpenImageIO 2.4 draws other characters wrongly) in DejaVu Sans of `size`
/// pixels.
int text_width(const std::string& text, int size);

/// Draws a line of text into an RGB or RGBA picture, in grey of `brightness` 0 to 1, opaque; its baseline starts at
/// pixel (left, baseline), rows from the bottom. What lies outside is cut off. Throws MachineLacks without the font.
void draw_text(Image<std::uint8_t>& image, int left, int baseline, const std::string& text, int size,
               float brightness = 1);

}  // namespace kiln
