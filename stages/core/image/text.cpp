// SPDX-License-Identifier: MIT
#include "image/text.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/errors.h"
#include "image/picture_codec.h"

namespace kiln {

namespace {

constexpr const char* font = "DejaVuSans";

}  // namespace

int text_width(const std::string& text, int size) { return picture_codec().text_width(text, size, font); }

void draw_text(Image<std::uint8_t>& image, int left, int baseline, const std::string& text, int size,
               float brightness) {
  // Ink has the top row first: draw it as high as the text can be, and flip it.
  const int above = size + size / 4, below = size / 2;
  const int width = std::min(image.width() - left, text_width(text, size) + size);
  if (width <= 0) return;
  std::vector<float> ink;
  const std::string fault = picture_codec().draw_text(text, size, font, above, width, above + below, ink);
  if (!fault.empty()) throw MachineLacks("text cannot be drawn (" + fault + "); install fonts-dejavu-core");
  for (int row = 0; row < above + below; ++row)
    for (int i = 0; i < width; ++i) {
      const int x = left + i, y = baseline + above - row;
      const float share = ink[static_cast<std::size_t>(row) * width + i];
      if (share <= 0 || x < 0 || y < 0 || y >= image.height()) continue;
      for (int c = 0; c < image.channels(); ++c) {
        std::uint8_t& value = image.at(x, y, c);
        const float wanted = c == 3 ? 255.f : 255.f * brightness;
        value = static_cast<std::uint8_t>(std::lround((1 - share) * static_cast<float>(value) + share * wanted));
      }
    }
}

}  // namespace kiln
