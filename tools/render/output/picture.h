// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "image/image.h"

namespace kiln {

/// How linear values of 0 to 1 become those of a PNG.
enum class ToneCurve {
  srgb,    ///< the transfer function of IEC 61966-2-1
  linear,  ///< as they are
};

struct PictureSettings {
  double exposure_stops = 0;  ///< radiance is multiplied by 2^this; not in an EXR
  ToneCurve tone = ToneCurve::srgb;
  std::optional<std::array<float, 3>> background;  ///< linear; none: transparent
};

/// 8-bit RGBA (alpha is coverage, not premultiplied), or RGB where there is a background, of radiance times coverage,
/// and coverage.
Image<std::uint8_t> picture_from_radiance(const Image<float>& radiance, const PictureSettings& settings);

/// Throws WrongUsage unless `file` ends in .png or .exr.
void require_picture_name(const std::filesystem::path& file);

/// A PNG of picture_from_radiance, or an EXR of the linear radiance itself (RGBA, premultiplied as EXR has it, the
/// background behind it), by the ending of `file`.
void write_picture(const std::filesystem::path& file, const Image<float>& radiance, const PictureSettings& settings);

}  // namespace kiln
