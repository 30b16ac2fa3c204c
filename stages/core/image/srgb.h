// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "image/image.h"

namespace kiln {

/// Encodes a linear value, clamped to 0 .. 1, as sRGB (IEC 61966-2-1).
float srgb_from_linear(float linear);

/// Decodes an sRGB value, clamped to 0 .. 1, to a linear one (IEC 61966-2-1).
float linear_from_srgb(float srgb);

/// Returns round(255 * value), with the value clamped to 0 .. 1.
std::uint8_t byte_from_unit(float value);

/// Encodes a picture of linear values as sRGB bytes, and decodes one.
Image<std::uint8_t> srgb_bytes(const Image<float>& linear);
Image<float> linear_from_srgb_bytes(const Image<std::uint8_t>& bytes);

}  // namespace kiln
