#pragma once

#include <cstdint>

#include "image/image.h"

namespace kiln {

/// The sRGB value (IEC 61966-2-1), 0 to 1, of a linear one, which is clamped to that.
float srgb_from_linear(float linear);

/// The linear value of an sRGB one (IEC 61966-2-1), 0 to 1, which is clamped to that.
float linear_from_srgb(float srgb);

/// round(255 * value), of a value clamped to 0 .. 1.
std::uint8_t byte_from_unit(float value);

/// A picture of linear values as sRGB bytes, and back.
Image<std::uint8_t> srgb_bytes(const Image<float>& linear);
Image<float> linear_from_srgb_bytes(const Image<std::uint8_t>& bytes);

}  // namespace kiln
