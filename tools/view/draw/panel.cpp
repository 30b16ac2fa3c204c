// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/draw/panel.h"

#include <algorithm>
#include <cmath>

#include "image/text.h"

namespace kiln {

namespace {

constexpr float title_brightness = 1.f, value_brightness = 0.92f, label_brightness = 0.6f;
constexpr std::uint8_t ground = 18;
constexpr float ground_alpha = 0.78f;

/// Sizes in pixels, on a display of the given scale.
struct Metrics {
  int size, title_size, line, margin, gap, under_title, corner, descent;

  explicit Metrics(double scale)
      : size(pixels(13, scale)),
        title_size(pixels(15, scale)),
        line(pixels(20, scale)),
        margin(pixels(12, scale)),
        gap(pixels(14, scale)),
        under_title(pixels(6, scale)),
        corner(pixels(7, scale)),
        descent(pixels(2, scale)) {}

 private:
  static int pixels(double at_96_dpi, double scale) { return static_cast<int>(std::lround(at_96_dpi * scale)); }
};

/// Computes how much of a pixel lies within a rectangle of that size with round corners.
float rounded_share(int i, int j, int width, int height, double radius) {
  const double x = std::max(std::abs(i + 0.5 - 0.5 * width) - (0.5 * width - radius), 0.0);
  const double y = std::max(std::abs(j + 0.5 - 0.5 * height) - (0.5 * height - radius), 0.0);
  return static_cast<float>(std::clamp(radius - std::hypot(x, y) + 0.5, 0.0, 1.0));
}

}  // namespace

Panel strip_of(const Panel& panel, int width, double scale) {
  const Metrics metrics(scale);
  Panel strip;
  std::string line = panel.title;
  for (const PanelRow& row : panel.rows) {
    const std::string entry = row.label + ": " + row.value;
    const std::string longer = line.empty() ? entry : line + "     " + entry;
    if (!line.empty() && text_width(longer, metrics.size) + 2 * metrics.margin > width) {
      strip.rows.push_back({"", line});
      line = entry;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) strip.rows.push_back({"", line});
  return strip;
}

Image<std::uint8_t> panel_picture(const Panel& panel, double scale) {
  const Metrics metrics(scale);
  const int size = metrics.size, title_size = metrics.title_size, line = metrics.line, margin = metrics.margin;
  int labels = 0, values = 0;
  for (const PanelRow& row : panel.rows) {
    labels = std::max(labels, text_width(row.label, size));
    values = std::max(values, text_width(row.value, size));
  }
  const int values_left = margin + (labels > 0 ? labels + metrics.gap : 0);
  const int title_height = panel.title.empty() ? 0 : line + metrics.under_title;
  const int width =
      std::max(values_left + values, panel.title.empty() ? 0 : margin + text_width(panel.title, title_size)) + margin;
  const int height = 2 * margin + title_height + static_cast<int>(panel.rows.size()) * line - (line - size);

  Image<std::uint8_t> picture(width, height, 4, ground);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      picture.at(i, j, 3) = static_cast<std::uint8_t>(
          std::lround(255 * ground_alpha * rounded_share(i, j, width, height, metrics.corner)));
  int baseline = height - margin - size + metrics.descent;
  if (!panel.title.empty()) {
    draw_text(picture, margin, baseline, panel.title, title_size, title_brightness);
    baseline -= title_height;
  }
  for (const PanelRow& row : panel.rows) {
    draw_text(picture, margin, baseline, row.label, size, label_brightness);
    draw_text(picture, values_left, baseline, row.value, size, value_brightness);
    baseline -= line;
  }
  return picture;
}

}  // namespace kiln
