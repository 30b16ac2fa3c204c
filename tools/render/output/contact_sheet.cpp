// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/output/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "image/text.h"

namespace kiln {

namespace {

constexpr std::uint8_t paper = 26;
constexpr int gap = 16;

/// Finds a text size at which every line fits the width of a cell.
int text_size_for(const std::vector<SheetCell>& cells, int width) {
  int size = std::clamp(width / 24, 10, 28);
  for (const SheetCell& cell : cells)
    for (const std::string& line : cell.caption)
      while (size > 6 && text_width(line, size) > width) --size;
  return size;
}

/// Finds the number of columns that makes a sheet of cells close to 16:9 with few places left empty.
int columns_for(int cells, int cell_width, int cell_height) {
  int best = 1;
  double least = 1e9;
  for (int columns = 1; columns <= cells; ++columns) {
    const int rows = (cells + columns - 1) / columns;
    const double aspect = static_cast<double>(columns) * cell_width / (static_cast<double>(rows) * cell_height);
    const double empty = static_cast<double>(rows * columns - cells) / cells;
    const double off = std::abs(std::log(aspect / (16.0 / 9))) + empty;
    if (off < least) {
      least = off;
      best = columns;
    }
  }
  return best;
}

}  // namespace

Image<std::uint8_t> contact_sheet(const std::vector<SheetCell>& cells) {
  const int width = cells.front().picture.width(), height = cells.front().picture.height();
  std::size_t lines = 0;
  for (const SheetCell& cell : cells) lines = std::max(lines, cell.caption.size());
  const int text = text_size_for(cells, width), line_height = text + text / 2;
  const int cell_height = height + static_cast<int>(lines) * line_height + text / 2;
  const int count = static_cast<int>(cells.size()), columns = columns_for(count, width + gap, cell_height + gap);
  const int rows = (count + columns - 1) / columns;
  Image<std::uint8_t> sheet(columns * (width + gap) + gap, rows * (cell_height + gap) + gap, 3, paper);
  for (int k = 0; k < count; ++k) {
    const SheetCell& cell = cells[static_cast<std::size_t>(k)];
    const int left = gap + k % columns * (width + gap);
    const int bottom = sheet.height() - (k / columns + 1) * (cell_height + gap) + cell_height - height;
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        const auto from = cell.picture.pixel(i, j);
        const float alpha = from.size() == 4 ? static_cast<float>(from[3]) / 255.f : 1.f;
        for (int c = 0; c < 3; ++c)
          sheet.at(left + i, bottom + j, c) =
              static_cast<std::uint8_t>(std::lround(alpha * static_cast<float>(from[c]) + (1 - alpha) * paper));
      }
    for (std::size_t line = 0; line < cell.caption.size(); ++line)
      draw_text(sheet, left, bottom - static_cast<int>(line + 1) * line_height, cell.caption[line], text,
                line == 0 ? 0.92f : 0.62f);
  }
  return sheet;
}

}  // namespace kiln
