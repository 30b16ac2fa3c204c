// SPDX-License-Identifier: MIT
#include "image/text.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <algorithm>
#include <cmath>

#include "base/errors.h"

namespace kiln {

namespace {

constexpr const char* font = "DejaVuSans";

}  // namespace

int text_width(const std::string& text, int size) {
  const OIIO::ROI box = OIIO::ImageBufAlgo::text_size(text, size, font);
  return box.defined() ? box.xend : 0;
}

void draw_text(Image<std::uint8_t>& image, int left, int baseline, const std::string& text, int size,
               float brightness) {
  // OpenImageIO counts rows from the top: draw into a picture of its own, as high as the text can be, and flip it.
  const int above = size + size / 4, below = size / 2;
  const int width = std::min(image.width() - left, text_width(text, size) + size);
  if (width <= 0) return;
  OIIO::ImageBuf line(OIIO::ImageSpec(width, above + below, 1, OIIO::TypeDesc::FLOAT));
  OIIO::ImageBufAlgo::zero(line);
  const float white = 1;
  if (!OIIO::ImageBufAlgo::render_text(line, 0, above, text, size, font, OIIO::cspan<float>(&white, 1)))
    throw MachineLacks("text cannot be drawn (" + line.geterror() + "); install fonts-dejavu-core");
  for (int row = 0; row < above + below; ++row)
    for (int i = 0; i < width; ++i) {
      const int x = left + i, y = baseline + above - row;
      const float share = line.getchannel(i, row, 0, 0);
      if (share <= 0 || x < 0 || y < 0 || y >= image.height()) continue;
      for (int c = 0; c < image.channels(); ++c) {
        std::uint8_t& value = image.at(x, y, c);
        const float wanted = c == 3 ? 255.f : 255.f * brightness;
        value = static_cast<std::uint8_t>(std::lround((1 - share) * static_cast<float>(value) + share * wanted));
      }
    }
}

}  // namespace kiln
