// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of OFF files after the Geomview manual, "OFF Files" (geomview.org/docs/html/OFF.html).

#include "import/off_colors.h"

#include <algorithm>
#include <limits>

namespace kiln {

void OffColorScale::add(bool is_whole, const Eigen::Vector3d& color, double alpha) {
  Kind& kind = is_whole ? whole_ : decimal_;
  kind.any = true;
  for (const double value : color)
    if (std::isfinite(value)) {
      kind.largest = std::max(kind.largest, value);
      kind.all_integers = kind.all_integers && value == std::trunc(value);
    }
  if (is_whole && alpha < HUGE_VAL) kind.largest = std::max(kind.largest, alpha);  // "1 0 0 255" is nearly black
  kind.least_alpha = std::min(kind.least_alpha, alpha);
}

double OffColorScale::full_value(bool is_whole) const {
  if (is_whole) return whole_.largest > 1 ? 255 : 1;
  // Floats of 0 to 1 may overshoot slightly.
  return decimal_.largest <= 1 || (decimal_.largest <= 2 && !decimal_.all_integers) ? 1 : 255;
}

void OffColorScale::add_warnings(std::vector<std::string>& warnings) const {
  const bool whole_is_unit = full_value(true) == 1, decimal_is_unit = full_value(false) == 1;
  if (whole_.any && whole_is_unit && !decimal_.any && whole_.largest > 0)
    warnings.emplace_back("colours were taken as 0 to 1: they are whole numbers, none above 1");
  if (decimal_.any && !decimal_is_unit)
    warnings.emplace_back("colours with a decimal point were taken as 0 to 255, because some are above 1");
  if (whole_.least_alpha < full_value(true) || decimal_.least_alpha < full_value(false))
    warnings.emplace_back("the alpha of colours is not used");
}

void OffColors::add(std::size_t index, bool is_whole, std::span<const double> numbers, OffColorScale& scale) {
  fill(index);
  const Eigen::Vector3d color(numbers[0], numbers[1], numbers[2]);
  scale.add(is_whole, color, numbers.size() > 3 ? numbers[3] : HUGE_VAL);
  colors_.emplace_back(color.cast<float>());
  is_whole_.push_back(is_whole);
  ++count_;
  any_negative_ = any_negative_ || color.minCoeff() < 0;
}

void OffColors::add_text(std::size_t index, std::span<const std::string_view> words, std::span<const double> numbers,
                         OffColorScale& scale) {
  const auto is_whole = [](std::string_view word) {
    return word.find_first_not_of("+-0123456789") == std::string_view::npos;
  };
  add(index, std::ranges::all_of(words.first(3), is_whole), numbers, scale);
}

void OffColors::add_floats(std::size_t index, std::span<const double> numbers, OffColorScale& scale) {
  add(index, false, numbers, scale);
}

/// Gives the vertices or faces below `size` without a colour the value for "none".
void OffColors::fill(std::size_t size) {
  colors_.resize(size, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  is_whole_.resize(size, false);
}

std::vector<Eigen::Vector3f> OffColors::take(std::size_t size, const OffColorScale& scale) {
  fill(size);
  for (std::size_t i = 0; i < colors_.size(); ++i) colors_[i] /= static_cast<float>(scale.full_value(is_whole_[i]));
  return std::move(colors_);
}

}  // namespace kiln
