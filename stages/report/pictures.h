// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "image/image.h"

namespace kiln {

/// Tells whether a pixel is wholly covered. Its coverage is a sum of sample shares, each of them rounded.
bool is_wholly_covered(float coverage);

/// Converts linear premultiplied RGBA radiance to an sRGB picture with alpha; values are clamped to 0 .. 1.
Image<std::uint8_t> shown_radiance(const Image<float>& radiance);

/// Draws `gain` times (a - b), averaged over the colours, where both are wholly covered: white for no difference, red
/// where `a` is brighter, blue where it is darker, full colour at 1. Grey where only one of them is covered,
/// transparent elsewhere.
Image<std::uint8_t> shown_difference(const Image<float>& a, const Image<float>& b, double gain);

/// Converts a PNG of 8 or 16 bits to 8 bits and at most `longest` pixels a side (averaged over areas).
Image<std::uint8_t> thumbnail(const std::filesystem::path& png, int bits, int longest);

/// Encodes bytes as base64 (RFC 4648, padded).
std::string base64(std::string_view bytes);

/// Returns the picture as the value of an `src` attribute: a PNG, written to `scratch` on its way.
std::string data_uri(const Image<std::uint8_t>& image, const std::filesystem::path& scratch);

}  // namespace kiln
