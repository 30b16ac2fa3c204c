// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "image/image.h"

namespace kiln {

/// Curve from linear values of 0 to 1 to those of a PNG.
enum class ToneCurve {
  srgb,    ///< transfer function of IEC 61966-2-1
  linear,  ///< values unchanged
};

struct PictureSettings {
  double exposure_stops = 0;  ///< radiance is multiplied by 2^this, except in an EXR
  ToneCurve tone = ToneCurve::srgb;
  std::optional<std::array<float, 3>> background;  ///< linear; nothing: transparent
};

/// Converts radiance (times coverage) and coverage to 8-bit RGBA (alpha is coverage, not premultiplied), or to RGB if
/// there is a background.
Image<std::uint8_t> picture_from_radiance(const Image<float>& radiance, const PictureSettings& settings);

/// Throws WrongUsage unless `file` ends in .png or .exr.
void require_picture_name(const std::filesystem::path& file);

/// Writes, by the ending of `file`, a PNG of picture_from_radiance or an EXR of the linear radiance (RGBA,
/// premultiplied as usual in EXR, with the background behind it).
void write_picture(const std::filesystem::path& file, const Image<float>& radiance, const PictureSettings& settings);

}  // namespace kiln
