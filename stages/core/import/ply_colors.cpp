// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of PLY files: the format [Turk 1994] has properties red, green and blue of type uchar. Others write floats of
// 0 to 1 (VTK, Blender), doubles of 0 to 1 (Open3D), unsigned shorts, or 0 to 255 in any type.

#include "import/ply_colors.h"

#include <algorithm>
#include <limits>

namespace kiln {

namespace {

/// Returns the unsigned value of a byte or short that was written as a signed one.
double without_sign(PlyType type, double value) {
  if (value >= 0) return value;
  if (type == PlyType::int8) return value + 256;
  return type == PlyType::int16 ? value + 65536 : value;
}

}  // namespace

void PlyColors::add(double red, double green, double blue) {
  Eigen::Vector3d color(red, green, blue);
  for (double& value : color) {
    value = without_sign(type_, value);
    if (!std::isfinite(value)) continue;
    largest_ = std::max(largest_, value);
    all_whole_ = all_whole_ && value == std::trunc(value);
  }
  colors_.emplace_back(color.cast<float>());
}

void PlyColors::add_alpha(double alpha) { least_alpha_ = std::min(least_alpha_, without_sign(type_, alpha)); }

void PlyColors::add_none() { colors_.emplace_back(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN())); }

std::vector<Eigen::Vector3f> PlyColors::take(std::vector<std::string>& warnings) {
  const double full = full_value(warnings);
  for (Eigen::Vector3f& color : colors_) color /= static_cast<float>(full);
  if (least_alpha_ < full) warnings.push_back("the alpha of the colours of " + owner_ + " is not used");
  return std::move(colors_);
}

std::string PlyColors::taken_as(const std::string& what) const {
  return "the colours of " + owner_ + " were taken as " + what;
}

double PlyColors::full_value(std::vector<std::string>& warnings) const {
  const std::size_t size = size_of(type_);
  if (is_float(type_)) return full_float(warnings);
  if (size == 1) return 255;
  if (size > 2 && largest_ <= 1) {
    if (largest_ > 0) warnings.push_back(taken_as("0 to 1: they are whole numbers, none above 1"));
    return 1;
  }
  if (largest_ <= 255) {
    if (size == 2 && largest_ > 0) warnings.push_back(taken_as("0 to 255: they have 16 bits, and none is above 255"));
    return 255;
  }
  if (size == 2 || largest_ <= 65535) return 65535;
  return type_ == PlyType::int32 ? 2147483647.0 : std::max(4294967295.0, largest_);
}

double PlyColors::full_float(std::vector<std::string>& warnings) const {
  // Floats of 0 to 1 may overshoot slightly.
  if (largest_ <= 1 || (largest_ <= 2 && !all_whole_)) return 1;
  if (largest_ <= 255) {
    warnings.push_back(taken_as("0 to 255: they are floats, and some are above 1"));
    return 255;
  }
  if (largest_ <= 65535 && all_whole_) {
    warnings.push_back(taken_as("0 to 65535: they are floats, and some are above 255"));
    return 65535;
  }
  return 1;
}

}  // namespace kiln
